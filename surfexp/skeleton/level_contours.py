"""All contours of a function at many levels at once, walked from face to face."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.skeleton.adjacency import opposite_sides
from surfexp.skeleton.feature import checked_feature

Flags = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class LevelContours:
    """The connected lines of {f = level}, sorted by level.

    A vertex at a level counts as above it, so that every contour is a closed curve or runs from boundary to boundary.

    Parameters
    ----------
    levels : (K,) float64
        Increasing.
    vertex_slabs : (n,) int64
        How many levels are at or below the value of a vertex: slab s lies between level s - 1 and level s.
    level : (C,) int64
        Which level each contour has.
    closed : (C,) bool
    starts : (C + 1,) int64
        The points of contour c are starts[c] to starts[c + 1]; a closed one does not repeat its first.
    ends : (P, 2) int64
        The vertices of the edge that each point lies on.
    shares : (P,) float64
        Position on that edge: 0 at its first vertex, 1 at its second.
    face_contours : (S,) int64
        The contour of each (face, level) pair that cross, face by face with rising levels.
    face_starts : (m + 1,) int64
        Where the pairs of a face begin.
    boundary_sides : int
        Sides of faces on the boundary; 0 on a closed surface.
    """

    levels: Floats
    vertex_slabs: Integers
    level: Integers
    closed: Flags
    starts: Integers
    ends: Integers
    shares: Floats
    face_contours: Integers
    face_starts: Integers
    boundary_sides: int

    def interpolate(self, values: Floats) -> Floats:
        """Values at the points of a function, or of positions, given at the vertices."""
        shares = self.shares.reshape(-1, *[1] * (np.ndim(values) - 1))
        return values[self.ends[:, 0]] * (1.0 - shares) + values[self.ends[:, 1]] * shares


def level_contours(mesh: TriangleMesh, values: Floats, levels: Floats) -> LevelContours:
    """Walk every contour of a piecewise linear function; the cost is linear in the number of crossed faces.

    Parameters
    ----------
    mesh : TriangleMesh
        A manifold; its orientation does not matter.
    values : (n,) float64
    levels : (K,) float64
        Increasing, at least one.

    Raises
    ------
    ValueError
        If values or levels are unfit, or an edge has three faces.
    """
    values, levels = checked_feature(values, len(mesh.vertices)), checked_levels(levels)
    slabs = np.searchsorted(levels, values, side="right").astype(np.int64)
    corners = slabs[mesh.faces]
    low, high = corners.min(axis=1), corners.max(axis=1)
    face_starts = np.concatenate([[0], np.cumsum(high - low)])
    twins = opposite_sides(mesh)
    boundary_sides = int((twins < 0).sum())
    points = int(face_starts[-1]) + boundary_sides * len(levels)
    label, level, closed, starts, ends = _walk(mesh.faces, twins, slabs, low, high, face_starts, points)
    order = np.argsort(level, kind="stable")
    position = np.empty(len(order), np.int64)
    position[order] = np.arange(len(order))
    counts = np.diff(starts)[order]
    new_starts = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
    gather = np.repeat(starts[:-1][order] - new_starts[:-1], counts) + np.arange(new_starts[-1])
    ends = ends[gather]
    below, above = values[ends[:, 0]], values[ends[:, 1]]
    shares = (np.repeat(levels[level[order]], counts) - below) / (above - below)
    label = position[label]
    return LevelContours(
        levels, slabs, level[order], closed[order], new_starts, ends, shares, label, face_starts, boundary_sides
    )


def checked_levels(levels: Floats) -> Floats:
    """Return levels as float64, refused unless they are finite and increase.

    Raises
    ------
    ValueError
        If there is none, or two are out of order.
    """
    checked = np.atleast_1d(np.ascontiguousarray(levels, dtype=np.float64))
    if not len(checked) or not np.isfinite(checked).all() or (np.diff(checked) <= 0).any():
        raise ValueError(f"{len(checked)} levels given, they must be finite and increase, and be at least 1")
    return checked


@njit(cache=True, nogil=True)
def _walk(
    faces: Integers,
    twins: Integers,
    slabs: Integers,
    low: Integers,
    high: Integers,
    face_starts: Integers,
    most_points: int,
) -> tuple[Integers, Integers, Flags, Integers, Integers]:
    label = np.full(face_starts[-1], -1, np.int64)
    level, closed = np.empty(face_starts[-1], np.int64), np.zeros(face_starts[-1], np.bool_)
    starts, ends = np.zeros(face_starts[-1] + 1, np.int64), np.empty((most_points, 2), np.int64)
    contours, points = 0, 0
    # open contours first, each from one of its ends on the boundary
    for opened in (True, False):
        for first in range(len(faces)):
            for k in range(low[first], high[first]):
                if label[face_starts[first] + k - low[first]] >= 0:
                    continue
                face, side = first, -1
                for j in range(3):
                    a, b = slabs[faces[first, j]], slabs[faces[first, (j + 1) % 3]]
                    if min(a, b) <= k < max(a, b) and (side < 0 or twins[3 * first + j] < 0):
                        side = 3 * first + j
                if opened and twins[side] >= 0:
                    continue
                level[contours], closed[contours] = k, not opened
                while True:
                    label[face_starts[face] + k - low[face]] = contours
                    a, b = faces[face, side % 3], faces[face, (side + 1) % 3]
                    ends[points, 0], ends[points, 1] = (a, b) if slabs[a] < slabs[b] else (b, a)
                    points += 1
                    for j in range(3):
                        a, b = faces[face, j], faces[face, (j + 1) % 3]
                        if 3 * face + j != side and min(slabs[a], slabs[b]) <= k < max(slabs[a], slabs[b]):
                            side = 3 * face + j
                            break
                    if twins[side] < 0:
                        a, b = faces[face, side % 3], faces[face, (side + 1) % 3]
                        ends[points, 0], ends[points, 1] = (a, b) if slabs[a] < slabs[b] else (b, a)
                        points += 1
                        break
                    side = twins[side]
                    face = side // 3
                    if face == first:
                        break
                contours += 1
                starts[contours] = points
    return label, level[:contours].copy(), closed[:contours].copy(), starts[: contours + 1].copy(), ends[:points].copy()
