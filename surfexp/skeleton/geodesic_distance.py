"""Geodesic distance from both sides: the length of a path, and a function that no path can fall short of."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.vertex_star import vertex_stars
from surfexp.operators.edge_flips import flip_to_delaunay, twin_sides
from surfexp.operators.intrinsic_delaunay import MOLLIFICATION, hat_gradients_from_lengths
from surfexp.skeleton.circular_fronts import march
from surfexp.skeleton.slope_contraction import contract
from surfexp.skeleton.straight_paths import beyond_sides, straighten

# rounds over all faces at most, and after how many of them it is asked whether any is left; what is steeper then is scaled
ROUNDS = 100
ROUNDS_AT_ONCE = 10
# a cone is too steep between the vertices around its tip: edges by which it is flattened there, times a logarithm
BLUNT = 0.15
# parts of the vertices after which progress is said
PARTS = 50
# slopes aimed at: a little less than 1, so that a face is done after few rounds
GOAL = 1.0 - 1e-3
FLIPS_OF_A_FACE = 100
# what opening slivers adds to the angles around a vertex
FULL_TURN = 1e-4

Progress = Callable[[int, float], None]


class GeodesicDistance(NamedTuple):
    """Distances of all vertices from a set of them, between two bounds.

    Parameters
    ----------
    upper : (n,) float64
        The length of a path on the mesh, rounding aside, in its unit; infinite where nothing leads.
    lower : (n,) float64
        No path is shorter.
    """

    upper: Floats
    lower: Floats


class _Triangulation(NamedTuple):
    """The intrinsic Delaunay triangulation of a mesh, in units of its size."""

    faces: Integers
    lengths: Floats
    twins: Integers
    start: Integers
    star: Integers
    unit: float


def geodesic_distance(mesh: TriangleMesh, sources: Integers, progress: Progress | None = None) -> Floats:
    """Return distances along the flat triangles of a mesh, however they are shaped: lengths of paths, none too short.

    Fronts run over the intrinsic Delaunay triangulation of the surface, as circles about the source unfolded into the plane.
    From each vertex a straight line runs back where the front came from; what counts is the shortest way over a vertex that
    it sees.

    Parameters
    ----------
    mesh : TriangleMesh
    sources : (s,) int64
        Vertices at distance 0.
    progress : callable, optional
        Called with the number of vertices that are done and the share of the work that is left.

    Returns
    -------
    (n,) float64
        Infinite where nothing leads.

    Raises
    ------
    ValueError
        If there is no source or it is no vertex.

    References
    ----------
    Kimmel, Sethian: Computing geodesic paths on manifolds (1998). Fisher, Springborn, Schroeder, Bobenko: An algorithm for
    the construction of intrinsic Delaunay triangulations (2007).
    """
    sources = _checked(sources, len(mesh.vertices))
    triangulation = _triangulated(mesh)
    return triangulation.unit * _paths(triangulation, sources, progress)


def geodesic_bounds(mesh: TriangleMesh, sources: Integers, progress: Progress | None = None) -> GeodesicDistance:
    """Return the distances of `geodesic_distance` with bounds from below.

    A linear function on each triangle whose slope is nowhere above 1 rises along no path by more than its length. The
    distances found, a little blunted at the sources, are flattened until they are such a function, triangle by triangle; what
    is left above 1 divides all.

    Parameters
    ----------
    mesh : TriangleMesh
    sources : (s,) int64
    progress : callable, optional
        As in `geodesic_distance`.

    Returns
    -------
    GeodesicDistance

    Raises
    ------
    ValueError
        As `geodesic_distance`.
    """
    sources = _checked(sources, len(mesh.vertices))
    triangulation = _triangulated(mesh)
    faces, lengths, _, start, star, unit = triangulation
    # paths and bounds take about as long
    upper = _paths(triangulation, sources, progress and (lambda done, left: progress(done, 0.5 + 0.5 * left)))
    reached = np.isfinite(upper)
    blunt = BLUNT * lengths.mean()
    flat = np.where(reached, upper - blunt * np.log1p(upper / blunt), 0.0)
    hats, _ = hat_gradients_from_lengths(lengths)
    for first in range(0, ROUNDS, ROUNDS_AT_ONCE):
        if contract(faces, hats, start, star, flat, GOAL, ROUNDS_AT_ONCE):
            break
        if progress is not None:
            progress(len(upper), 0.5 - 0.5 * (first + ROUNDS_AT_ONCE) / ROUNDS)
    steepest = float(np.linalg.norm(np.einsum("fk,fkx->fx", flat[faces], hats), axis=1).max(initial=0.0))
    lower = np.maximum(flat - flat[sources].max(), 0.0) / max(steepest, 1.0)
    return GeodesicDistance(unit * upper, unit * np.where(reached, np.minimum(lower, upper), np.inf))


def _checked(sources: Integers, count: int) -> Integers:
    sources = np.unique(np.asarray(sources, dtype=np.int64))
    if not len(sources) or sources[0] < 0 or sources[-1] >= count:
        raise ValueError(f"{len(sources)} source vertices given, at least 1 in 0..{count - 1} is needed")
    return sources


def _triangulated(mesh: TriangleMesh) -> _Triangulation:
    """Slivers are opened by a millionth of the mean length, as for the operator of this triangulation."""
    unit = float(np.abs(mesh.vertices - mesh.vertices.mean(axis=0)).max()) or 1.0
    corners = (mesh.vertices / unit)[mesh.faces]
    lengths = np.linalg.norm(corners[:, [1, 2, 0]] - corners, axis=2)
    slack = lengths.sum(axis=1, keepdims=True) - 2.0 * lengths
    lengths += max(0.0, float(MOLLIFICATION * lengths.mean() - slack.min(initial=np.inf)))
    faces, twins = mesh.faces.copy(), twin_sides(mesh.faces)
    flip_to_delaunay(faces, lengths, twins, FLIPS_OF_A_FACE * len(faces))
    start, star = vertex_stars(faces, len(mesh.vertices))
    return _Triangulation(faces, lengths, twins, start, star, unit)


def _paths(triangulation: _Triangulation, sources: Integers, progress: Progress | None) -> Floats:
    faces, lengths, twins, start, star, _ = triangulation
    bends = _bending(faces, lengths, twins, len(start) - 1)
    distances, came = march(faces, lengths, start, star, sources, bends)
    upper = np.full(len(distances), np.inf)
    upper[sources] = 0.0
    order = np.argsort(distances)
    order = order[np.isfinite(distances[order]) & (upper[order] > 0.0)]
    corners, places = beyond_sides(faces, lengths, twins)
    done = 0
    for part in np.array_split(order, PARTS):
        straighten(part, upper, faces, lengths, came, corners, places)
        done += len(part)
        if progress is not None and done:
            # lines grow with the distance
            progress(done, 1.0 - (done / len(order)) ** 1.5)
    return upper


def _bending(faces: Integers, lengths: Floats, twins: Integers, count: int) -> NDArray[np.bool_]:
    """Where shortest paths may bend: at vertices with more than a full turn around them, on the boundary more than half of one."""
    angles = np.zeros(count)
    for k in range(3):
        one, other, opposite = lengths[:, k], lengths[:, (k + 2) % 3], lengths[:, (k + 1) % 3]
        cosine = (one**2 + other**2 - opposite**2) / np.maximum(2.0 * one * other, np.finfo(float).tiny)
        angles += np.bincount(faces[:, k], np.arccos(np.clip(cosine, -1.0, 1.0)), count)
    open_sides = np.flatnonzero(twins < 0)
    most = np.full(count, 2.0 * np.pi)
    most[faces.ravel()[open_sides]] = np.pi
    most[np.roll(faces, -1, axis=1).ravel()[open_sides]] = np.pi
    return np.asarray(angles > most + FULL_TURN)
