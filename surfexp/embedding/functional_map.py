"""Maps between surfaces by orthogonal alignment of eigenfunctions: spectral ICP, functional maps and ZoomOut."""

from __future__ import annotations

import numpy as np

from surfexp.embedding.nearest import nearest
from surfexp.embedding.spectral_embedding import SpectralEmbedding
from surfexp.mesh.triangle_mesh import Floats, Integers
from surfexp.spectrum.eigensystem import EigenSystem


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
        Orthogonal, such as the optimal signs; target points times it are compared with source points.
    iterations : int
        At most; it stops when the map repeats.

    Returns
    -------
    (t,) int64, (n, n) float64
        Source vertex of each target vertex, and the last basis.
    """
    rows = nearest(target.points @ basis, source.points)[0]
    for _ in range(iterations):
        basis = nearest_orthogonal((target.points * target.weights[:, None]).T @ source.points[rows])
        previous, rows = rows, nearest(target.points @ basis, source.points)[0]
        if (rows == previous).all():
            break
    return rows, basis


def functional_map(source: Floats, target: Floats, target_weights: Floats, rows: Integers) -> Floats:
    """Return the (t_modes, s_modes) matrix of f -> f o map in two orthonormal bases (Ovsjanikov et al. 2012).

    Parameters
    ----------
    source, target : (s, k) and (t, k) float64
        Eigenfunctions by columns, orthonormal for the weights.
    target_weights : (t,) float64
    rows : (t,) int64
        The map: source vertex of each target vertex.
    """
    return np.asarray((target * target_weights[:, None]).T @ source[rows])


def zoomout(
    source: EigenSystem,
    target: EigenSystem,
    areas: tuple[Floats, Floats],
    rows: Integers,
    first: int = 10,
    last: int = 80,
    step: int = 2,
    samples: int = 2000,
    seed: int = 0,
) -> Integers:
    """Refine a map by functional maps of growing size (Melzi et al. 2019), on samples until the last step.

    Parameters
    ----------
    source, target : EigenSystem
        At least `last` pairs each.
    areas : tuple of (s,) and (t,) float64
        Vertex areas.
    rows : (t,) int64
        The map to begin with: source vertex of each target vertex.
    first, last, step : int
        Sizes of the functional map.
    samples : int
        Vertices of either surface that take part before the last step.

    Returns
    -------
    (t,) int64

    Raises
    ------
    ValueError
        If there are fewer pairs than `last`, or the sizes are not increasing.
    """
    most = min(len(source.values), len(target.values))
    if not 1 <= first <= last <= most or step < 1:
        raise ValueError(f"sizes {first} to {last} in steps of {step}: take 1 <= first <= last <= {most}, step >= 1")
    first_area, second_area = float(areas[0].sum()), float(areas[1].sum())
    phi, psi = source.vectors * np.sqrt(first_area), target.vectors * np.sqrt(second_area)
    weights = areas[1] / second_area
    rng = np.random.default_rng(seed)
    s = np.sort(rng.choice(len(phi), min(samples, len(phi)), replace=False))
    t = np.sort(rng.choice(len(psi), min(samples, len(psi)), replace=False))
    some = rows[t]
    draws = np.full(len(t), 1.0 / len(t)) if len(t) < len(psi) else weights[t]
    draws = draws if len(t) == len(psi) else weights[t] / weights[t].sum()
    for size in range(first, last, step):
        matrix = _regular(psi[t, :size], draws, phi[some, :size])
        some = s[nearest(psi[t, :size] @ matrix, phi[s, :size])[0]]
    matrix = _regular(psi[t, :last], draws, phi[some, :last])
    return nearest(psi[:, :last] @ matrix, phi[:, :last])[0]


def _regular(target: Floats, weights: Floats, pulled: Floats) -> Floats:
    """The functional map by weighted least squares, which samples need: their functions are not quite orthonormal."""
    weighted = target * weights[:, None]
    return np.asarray(np.linalg.solve(weighted.T @ target, weighted.T @ pulled))


def refine_with_field(
    source: EigenSystem,
    target: EigenSystem,
    areas: tuple[Floats, Floats],
    rows: Integers,
    fields: tuple[Floats, Floats],
    modes: int = 60,
    share: float = 0.2,
    iterations: int = 5,
) -> Integers:
    """Refine a map in the global point embedding with one more coordinate: a field known on both surfaces.

    Parameters
    ----------
    fields : tuple of (s,) and (t,) float64
        Such as sulcal depth; brought to mean 0 and deviation 1.
    modes : int
        Size of the functional map.
    share : float
        Root mean square of the field over that of the embedding.

    Returns
    -------
    (t,) int64
    """
    most = min(len(source.values), len(target.values))
    if not 2 <= modes <= most:
        raise ValueError(f"modes = {modes}, take 2 <= modes <= {most}")
    total = float(areas[0].sum()), float(areas[1].sum())
    phi, psi = source.vectors[:, :modes] * np.sqrt(total[0]), target.vectors[:, :modes] * np.sqrt(total[1])
    weights = 1.0 / np.sqrt(np.concatenate([[1.0], source.values[1:modes] * total[0]]))
    extras = []
    for field, area in zip(fields, areas, strict=True):
        mean = field @ area / area.sum()
        spread = np.sqrt((field - mean) ** 2 @ area / area.sum())
        if not spread > 1e-9 * float(np.abs(field).max()):
            raise ValueError(f"the field is constant at {mean:g}: take one that varies")
        extras.append((field - mean) / spread)
    scale = share * float(np.sqrt(((phi * weights) ** 2).sum(axis=1).mean()))
    points = np.column_stack([phi * weights, scale * extras[0]])
    for _ in range(iterations):
        matrix = functional_map(phi, psi, areas[1] / total[1], rows)
        previous, rows = rows, nearest(np.column_stack([psi @ matrix * weights, scale * extras[1]]), points)[0]
        if (rows == previous).all():
            break
    return rows
