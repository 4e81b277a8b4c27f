"""Polygons and triangle strips to triangles."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from surfexp.contract.arrays import Integers


def triangulate(polygons: Sequence[Sequence[int]]) -> Integers:
    """(m, 3) faces: each polygon as a fan around its first vertex, in order.

    Raises
    ------
    ValueError
        If a polygon has fewer than three vertices.
    """
    if not polygons:
        return np.zeros((0, 3), dtype=np.int64)
    sizes = np.fromiter(map(len, polygons), dtype=np.int64, count=len(polygons))
    if sizes.min() < 3:
        index = int(sizes.argmin())
        raise ValueError(f"face {index} has {sizes[index]} vertices, at least 3 are needed")
    if sizes.max() == 3:
        return np.array(polygons, dtype=np.int64)
    corners = [[p[0], p[k], p[k + 1]] for p in polygons for k in range(1, len(p) - 1)]
    return np.array(corners, dtype=np.int64)


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
