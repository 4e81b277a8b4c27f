"""Polygons and triangle strips to triangles."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from mapbox_earcut import triangulate_float64
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.given_arrays import index_array

FLATNESS = 0.01
ROUNDING = 1e-12
# first ears after which triangles of another area than the polygon's say that it crosses itself
CROSSED = 64
FEWEST_TURNS, MOST_CORNERS = 8, 10**5


def triangulate(
    polygons: NDArray[np.generic] | Sequence[Sequence[int]], points: Floats
) -> tuple[Integers, tuple[str, ...]]:
    """Cut polygons into triangles, convex ones as a fan around their first vertex and others by ears, in their plane.

    Ears are cut by mapbox_earcut in the plane of Newell's normal. Every polygon keeps its orientation, and every vertex
    stays a corner, also one on a straight side, since a neighbour may meet it there.

    Parameters
    ----------
    polygons : (m, k) int64, or sequence of sequences of int
    points : (n, 3) float64

    Returns
    -------
    faces : (t, 3) int64
        In the order of the polygons.
    notes : tuple of str
        Which polygons are bent or cross themselves, so that their triangles are one choice of several.

    Raises
    ------
    ValueError
        If a polygon has fewer than three vertices.
    """
    if not len(polygons):
        return np.zeros((0, 3), dtype=np.int64), ()
    if isinstance(polygons, np.ndarray) and polygons.shape[1:] == (3,):
        return index_array(polygons, "the faces"), ()
    cut = [_without_repeats(polygon) if len(polygon) > 3 else polygon for polygon in polygons]
    sizes = np.fromiter(map(len, cut), dtype=np.int64, count=len(cut))
    if sizes.min() < 3:
        index = int(sizes.argmin())
        raise ValueError(f"face {index} has {sizes[index]} vertices, at least 3 are needed")
    starts = np.concatenate([[0], np.cumsum(sizes - 2)])
    faces = np.empty((starts[-1], 3), dtype=np.int64)
    bent, crossing = 0, 0
    for size in np.unique(sizes).tolist():
        chosen = np.flatnonzero(sizes == size)
        corners = index_array(np.array([cut[k] for k in chosen.tolist()]), "the faces")
        place = starts[chosen][:, None] + np.arange(size - 2)
        fans = np.stack([np.broadcast_to(corners[:, :1], place.shape), corners[:, 1:-1], corners[:, 2:]], axis=2)
        faces[place] = fans
        # a corner that is no vertex is refused by the check of the whole
        if size == 3 or not len(points) or corners.min() < 0 or corners.max() >= len(points):
            continue
        convex, flat = _shapes(points[corners])
        bent += int((~flat).sum())
        for k in np.flatnonzero(~convex).tolist():
            ears, whole = _ears(points[corners[k]])
            crossing += not whole
            if whole:
                faces[place[k]] = corners[k][ears]
    return faces, tuple(_sentences(bent, crossing))


def _without_repeats(polygon: Sequence[Any] | NDArray[np.generic]) -> Sequence[Any] | NDArray[np.generic]:
    """A polygon without corners that follow themselves, as a triangle that is written with four; at least a triangle."""
    corners = list(polygon)
    kept = [one for one, after in zip(corners, [*corners[1:], corners[0]], strict=True) if one != after]
    return polygon if len(kept) == len(corners) or len(kept) < 3 else kept


def _sentences(bent: int, crossing: int) -> Iterator[str]:
    if bent:
        yield f"{bent} polygons are bent by more than {FLATNESS:.0%} of their size: their area depends on the cut."
    if crossing:
        yield f"{crossing} polygons cross themselves or have no area, and are cut as fans: their area may be wrong."


def _shapes(polygons: Floats) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Return which polygons (m, k, 3) are convex, and which are flat."""
    centred = polygons - polygons.mean(axis=1, keepdims=True)
    size = np.linalg.norm(centred, axis=2).max(axis=1)
    scaled = centred / np.where(size > 0, size, 1.0)[:, None, None]
    after = np.roll(scaled, -1, axis=1)
    normal = np.cross(scaled, after).sum(axis=1)
    length = np.linalg.norm(normal, axis=1)
    normal /= np.where(length > 0, length, 1.0)[:, None]
    sides = after - scaled
    before = np.roll(sides, 1, axis=1)
    turns = np.einsum("mkc,mc->mk", np.cross(before, sides), normal)
    angles = np.arctan2(turns, (before * sides).sum(axis=2)).sum(axis=1)
    # strictly: a fan around a vertex on a straight side would have a triangle without area
    convex = (turns > ROUNDING).all(axis=1) & (np.abs(angles - 2 * np.pi) < 1e-3)
    flat = np.abs(np.einsum("mkc,mc->mk", scaled, normal)).max(axis=1) <= FLATNESS
    return convex, flat


def _ears(polygon: Floats) -> tuple[Integers, bool]:
    """Return (k - 2, 3) places of corners of a polygon's triangles, and whether they cover it exactly."""
    centred = polygon - polygon.mean(axis=0)
    # the two axes of largest extent are not enough for bent polygons: their plane is that of Newell's normal
    normal = np.cross(centred, np.roll(centred, -1, axis=0)).sum(axis=0)
    if not np.linalg.norm(normal) > 0:
        return np.zeros((0, 3), dtype=np.int64), False
    axes = np.linalg.svd(normal[None])[2]
    frame = axes[1:] if np.linalg.det(np.vstack([axes[1:], normal])) > 0 else axes[:0:-1]
    plane = centred @ frame.T
    x, y = plane.T
    area = float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
    count, missed = len(polygon), 0
    # so many that a polygon of very many corners, none of whose ears fit, does not take hours
    for turn in range(min(count, max(FEWEST_TURNS, MOST_CORNERS // count))):
        # which ear comes first decides whether a vertex on a straight side stays a corner
        order = np.roll(np.arange(count), -turn)
        ears = order[triangulate_float64(plane[order], np.array([count], np.uint32)).reshape(-1, 3).astype(np.int64)]
        first, second = plane[ears[:, 1]] - plane[ears[:, 0]], plane[ears[:, 2]] - plane[ears[:, 0]]
        areas = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
        whole = abs(np.abs(areas).sum() - area) <= 1e-9 * area
        missed += not whole
        if missed == CROSSED or (turn == 1 and _has_a_side_twice(polygon)):
            break
        if len(ears) == count - 2 and whole and np.abs(areas).min() > ROUNDING * area:
            return np.where((areas < 0)[:, None], ears[:, ::-1], ears), True
    return np.zeros((0, 3), dtype=np.int64), False


def _has_a_side_twice(polygon: Floats) -> bool:
    """Whether a side is walked twice in one direction; the two sides of a cut to a hole are walked in both, once each."""
    corner = np.unique(polygon, axis=0, return_inverse=True)[1].ravel()
    sides = corner * len(polygon) + np.roll(corner, -1)
    return len(np.unique(sides)) < len(sides)


def polygons_between(starts: Sequence[int], corners: Sequence[int]) -> list[Sequence[int]]:
    """Cut the corners of all polygons into those of each, as VTK keeps them.

    Parameters
    ----------
    starts : (m + 1,) sequence of int
        Place of the first corner of each polygon, and the number of corners.
    corners : sequence of int

    Raises
    ------
    ValueError
        If places do not rise from 0 to the number of corners.
    """
    if not len(starts) or starts[0] != 0 or starts[-1] != len(corners):
        ends = f"from {starts[0]} to {starts[-1]}" if len(starts) else "nowhere"
        raise ValueError(f"its polygons go {ends}, there are {len(corners)} corners")
    for number, (start, stop) in enumerate(pairwise(starts)):
        if stop < start:
            raise ValueError(f"polygon {number} begins at corner {start} and ends at {stop}")
    return [corners[start:stop] for start, stop in pairwise(starts)]


def triangles_of_strips(strips: Sequence[Sequence[int]]) -> Integers:
    """(m, 3) faces of triangle strips: every vertex makes a triangle with the two before it, -1 begins a new strip.

    Every second triangle of a strip is turned over, so that all have one orientation; triangles with a repeated vertex,
    which strips use to turn a corner, are left out.
    """
    ends = [np.append(np.asarray(strip, dtype=np.int64), -1) for strip in strips]
    numbers = np.concatenate(ends) if ends else np.zeros(0, dtype=np.int64)
    if len(numbers) < 3:
        return np.zeros((0, 3), dtype=np.int64)
    place = np.arange(len(numbers))
    since_end = place - np.maximum.accumulate(np.where(numbers < 0, place, -1)) - 1
    faces = np.stack([numbers[:-2], numbers[1:-1], numbers[2:]], axis=1)
    odd = since_end[:-2] % 2 == 1
    faces[odd] = faces[odd][:, [1, 0, 2]]
    a, b, c = faces.T
    return np.ascontiguousarray(faces[(faces >= 0).all(axis=1) & (a != b) & (b != c) & (c != a)])
