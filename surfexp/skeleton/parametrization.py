"""The parametrisation of a patch by its level sets (section 5.6): u along the skeleton, v along each contour."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.skeleton.contour_geometry import contour_lengths, representatives, resampled
from surfexp.skeleton.level_contours import level_contours
from surfexp.skeleton.pruning import surviving_nodes
from surfexp.skeleton.reeb_graph import reeb_graph


@dataclass(frozen=True, eq=False)
class LevelSetParametrization:
    """A grid of points on a patch whose contours are single open lines.

    Parameters
    ----------
    u : (K,) float64
        Place along the skeleton, through the middles of the contours, as a share of its length.
    v : (M,) float64
        Place along each contour, as a share of its length.
    points : (K, M, 3) float64
    width : (K,) float64
        Length of each contour.
    maps : dict of str to (K, M) float64
        Functions given at the vertices, on the grid.
    left_out : int
        Contours around teeth of the edge that are not on the grid.
    """

    u: Floats
    v: Floats
    points: Floats
    width: Floats
    maps: dict[str, Floats] = field(default_factory=dict)
    left_out: int = 0


def level_set_parametrization(
    mesh: TriangleMesh,
    values: Floats,
    levels: Floats,
    across: int = 21,
    maps: dict[str, Floats] | None = None,
    persistence: float = 0.0,
) -> LevelSetParametrization:
    """Grid points at equal steps of arc length on every contour.

    All contours run the same way: from the left edge to the right one, seen with rising levels ahead and the surface's
    normal up.

    Parameters
    ----------
    mesh : TriangleMesh
    values : (n,) float64
    levels : (K,) float64
        Increasing.
    across : int
        Points on each contour, at least 2.
    maps : dict of str to (n,) float64, optional
        Functions to be read off on the grid.
    persistence : float
        Contours on branches of the Reeb graph that are cut at this share of the range are left out, as in `pruned`: they
        run around teeth of a jagged edge.

    Raises
    ------
    ValueError
        If some level has more than one contour that counts, or a closed one.
    """
    if across < 2:
        raise ValueError(f"{across} points across asked for, at least 2 are needed")
    contours = level_contours(mesh, values, levels)
    lengths = contour_lengths(contours, mesh.vertices)
    graph = reeb_graph(mesh, values, contours.levels)
    # its first nodes are the contours, in their order
    counted = surviving_nodes(graph, persistence)[: len(lengths)]
    counts = np.bincount(contours.level[counted], minlength=len(contours.levels))
    closed = np.bincount(contours.level[counted], contours.closed[counted], len(counts)) > 0
    if (counts != 1).any() or closed.any():
        bad = int(np.argmax((counts != 1) | closed))
        what = "closed" if closed[bad] else "open"
        raise ValueError(
            f"level {contours.levels[bad]:g} has {counts[bad]} contours, {what}; a single open one is needed at each"
        )
    kept = np.flatnonzero(counted)
    points = resampled(contours, mesh.vertices, mesh.vertices, across)[kept]
    turned = np.flatnonzero(_runs_leftward(mesh, points))
    sampled = {
        name: resampled(contours, np.asarray(function, dtype=float), mesh.vertices, across)[kept]
        for name, function in (maps or {}).items()
    }
    for grid in (points, *sampled.values()):
        grid[turned] = grid[turned, ::-1]
    steps = np.linalg.norm(np.diff(representatives(contours, mesh.vertices)[0][kept], axis=0), axis=1)
    travelled = np.concatenate([[0.0], np.cumsum(steps)])
    u = travelled / travelled[-1] if travelled[-1] > 0 else travelled
    return LevelSetParametrization(
        u, np.linspace(0.0, 1.0, across), points, lengths[kept], sampled, len(lengths) - len(kept)
    )


def _runs_leftward(mesh: TriangleMesh, points: Floats) -> np.ndarray:
    """Which lines of points run from right to left, by the normal of the vertex nearest to their middle."""
    from scipy.spatial import cKDTree

    middles = points[:, points.shape[1] // 2]
    ahead = np.gradient(middles, axis=0) if len(middles) > 1 else np.zeros_like(middles)
    normals = mesh.vertex_normals[cKDTree(mesh.vertices).query(middles)[1]]
    rightward = np.cross(ahead, normals)
    return np.einsum("kx,kx->k", points[:, -1] - points[:, 0], rightward) < 0
