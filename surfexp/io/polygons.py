"""Polygons to triangles."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from surfexp.arrays import Integers


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
