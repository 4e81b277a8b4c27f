"""The parametrisation of a patch by its level sets (section 5.6): u along the skeleton, v along each contour."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from surfexp.mesh.triangle_mesh import Floats, TriangleMesh
from surfexp.skeleton.contour_geometry import contour_lengths, resampled
from surfexp.skeleton.level_contours import level_contours


@dataclass(frozen=True, eq=False)
class LevelSetParametrization:
    """A grid of points on a patch whose contours are single open lines.

    Parameters
    ----------
    u : (K,) float64
        Place along the skeleton, as a share of its length.
    v : (M,) float64
        Place along each contour, as a share of its length.
    points : (K, M, 3) float64
    width : (K,) float64
        Length of each contour.
    maps : dict of str to (K, M) float64
        Functions given at the vertices, on the grid.
    """

    u: Floats
    v: Floats
    points: Floats
    width: Floats
    maps: dict[str, Floats] = field(default_factory=dict)


def level_set_parametrization(
    mesh: TriangleMesh, values: Floats, levels: Floats, across: int = 21, maps: dict[str, Floats] | None = None
) -> LevelSetParametrization:
    """Grid points at equal steps of arc length on every contour.

    All contours run the same way: from the left edge to the right one, seen with rising levels ahead and the surface's
    normal up.

    Raises
    ------
    ValueError
        If some level has more than one contour, or a closed one.
    """
    contours = level_contours(mesh, values, levels)
    counts = np.bincount(contours.level, minlength=len(contours.levels))
    if (counts != 1).any() or contours.closed.any():
        bad = int(np.argmax((counts != 1) | np.bincount(contours.level, contours.closed, len(counts)).astype(bool)))
        raise ValueError(
            f"level {contours.levels[bad]:g} has {counts[bad]} contours, a single open one is needed at each"
        )
    points = resampled(contours, mesh.vertices, mesh.vertices, across)
    turned = np.flatnonzero(_runs_leftward(mesh, points))
    points[turned] = points[turned, ::-1]
    sampled = {}
    for name, function in (maps or {}).items():
        found = resampled(contours, np.asarray(function, dtype=float), mesh.vertices, across)
        found[turned] = found[turned, ::-1]
        sampled[name] = found
    middles = points[:, across // 2]
    steps = np.linalg.norm(np.diff(middles, axis=0), axis=1)
    travelled = np.concatenate([[0.0], np.cumsum(steps)])
    u = travelled / travelled[-1] if travelled[-1] > 0 else travelled
    width = contour_lengths(contours, mesh.vertices)
    return LevelSetParametrization(u, np.linspace(0.0, 1.0, across), points, width, sampled)


def _runs_leftward(mesh: TriangleMesh, points: Floats) -> np.ndarray:
    """Which lines of points run from right to left, by the normal of the vertex nearest to their middle."""
    from scipy.spatial import cKDTree

    middles = points[:, points.shape[1] // 2]
    ahead = np.gradient(middles, axis=0) if len(middles) > 1 else np.zeros_like(middles)
    normals = mesh.vertex_normals[cKDTree(mesh.vertices).query(middles)[1]]
    rightward = np.cross(ahead, normals)
    return np.einsum("kx,kx->k", points[:, -1] - points[:, 0], rightward) < 0
