"""Vertex maps and functional maps, each from the other, in the one direction that the whole package keeps to.

A vertex map sends each target vertex to a source vertex: `rows`, of shape (t,). Its functional map C, of shape
(target modes, source modes), takes the coefficients of a function on the source to those of the same function carried to
the target (Ovsjanikov et al. 2012). Back from C to a vertex map the source points are moved, `source @ C.T`, and
searched; the target points are compared with them as they are (Melzi et al. 2019, section 4). The adjoint, `target @ C`
compared with `source`, gives another map unless C is orthogonal: the modes that a truncated C loses shrink the target's
points toward the source's middle, and the map with them.
"""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.embedding.nearest import nearest
from surfexp.embedding.spectral_embedding import SpectralEmbedding


def nearest_orthogonal(matrix: Floats) -> Floats:
    """Return the orthogonal matrix that is nearest to a square one (Procrustes)."""
    left, _, right = np.linalg.svd(matrix)
    return np.asarray(left @ right)


def spectral_icp(
    source: SpectralEmbedding, target: SpectralEmbedding, basis: Floats, iterations: int = 30
) -> tuple[Integers, Floats]:
    """Alternate nearest neighbours and the best orthogonal matrix, from `basis` on (Mateus et al. 2008).

    Parameters
    ----------
    basis : (n, n) float64
        Orthogonal functional map to begin with, such as the diagonal matrix of the optimal signs.
    iterations : int
        At most; it stops when the map repeats.

    Returns
    -------
    (t,) int64, (n, n) float64
        Source vertex of each target vertex, and the last basis.
    """
    rows = vertex_map(basis, source.points, target.points)
    for _ in range(iterations):
        basis = orthogonal_map(source.points, target.points, target.weights, rows)
        previous, rows = rows, vertex_map(basis, source.points, target.points)
        if (rows == previous).all():
            break
    return rows, basis


def functional_map(source: Floats, target: Floats, target_weights: Floats, rows: Integers) -> Floats:
    """Return the (t_modes, s_modes) functional map of a vertex map, by least squares in the target's area.

    Where the target's modes are orthonormal for the weights this is target' diag(weights) source[rows]; on a sample of
    the vertices, or with lumped areas under modes of a consistent mass, they are not quite.

    Parameters
    ----------
    source, target : (s, s_modes), (t, t_modes) float64
        Eigenfunctions by columns.
    target_weights : (t,) float64
        Positive, up to a factor.
    rows : (t,) int64
        The map: source vertex of each target vertex.
    """
    weighted = target * target_weights[:, None]
    return np.asarray(np.linalg.solve(weighted.T @ target, weighted.T @ source[rows]))


def orthogonal_map(source: Floats, target: Floats, target_weights: Floats, rows: Integers) -> Floats:
    """Return the orthogonal (n, n) functional map that brings source points nearest to those mapped to them."""
    return nearest_orthogonal((target * target_weights[:, None]).T @ source[rows])


def vertex_map(matrix: Floats, source: Floats, target: Floats) -> Integers:
    """Return the source row of each target row: the nearest of the source's points moved by a functional map.

    Parameters
    ----------
    matrix : (t_modes, s_modes) float64
        Functional map from source to target.
    source, target : (s, s_modes), (t, t_modes) float64
    """
    return nearest(target, source @ matrix.T)[0]
