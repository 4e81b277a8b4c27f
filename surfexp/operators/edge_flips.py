"""Flips of a triangulation known by edge lengths alone, until every edge is Delaunay."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats, Integers

DELAUNAY_SLACK = 1e-10


def twin_sides(faces: Integers) -> Integers:
    """Return for each side 3 f + k, from corner k to corner k + 1, the side that it is glued to, or -1.

    Only edges with exactly two faces that run through them in opposite directions are glued; the rest, on a boundary, not a
    manifold or not oriented, are never flipped.

    Parameters
    ----------
    faces : (m, 3) int64

    Returns
    -------
    (3 m,) int64
    """
    tails, heads = faces.ravel(), faces[:, [1, 2, 0]].ravel()
    size = int(faces.max()) + 1
    keys = np.minimum(tails, heads) * size + np.maximum(tails, heads)
    order = np.argsort(keys, kind="stable")
    _, starts, counts = np.unique(keys[order], return_index=True, return_counts=True)
    first, second = order[starts[counts == 2]], order[starts[counts == 2] + 1]
    opposite = (tails[first] == heads[second]) & (tails[first] != heads[first])
    twins = np.full(len(tails), -1, dtype=np.int64)
    twins[first[opposite]], twins[second[opposite]] = second[opposite], first[opposite]
    return twins


@njit(cache=True, nogil=True)
def flip_to_delaunay(faces: Integers, lengths: Floats, twins: Integers, limit: int) -> int:
    """Flip sides in place until all are Delaunay or `limit` flips are made; return the number of flips.

    `lengths` (m, 3) are those of the sides from corner k to corner k + 1.
    """
    count = len(faces)
    queue = np.arange(3 * count)
    waiting = np.ones(3 * count, dtype=np.bool_)
    pending, flips = 3 * count, 0
    while pending > 0 and flips < limit:
        pending -= 1
        side = queue[pending]
        waiting[side] = False
        twin = twins[side]
        if twin < 0 or twin // 3 == side // 3:
            continue
        if _cotangent(lengths, side) + _cotangent(lengths, twin) >= -DELAUNAY_SLACK:
            continue
        for touched in _flip(faces, lengths, twins, side, twin):
            if twins[touched] >= 0 and not waiting[touched]:
                waiting[touched] = True
                queue[pending] = touched
                pending += 1
        flips += 1
    return flips


@njit(cache=True, nogil=True)
def _cotangent(lengths: Floats, side: int) -> float:
    """Return the cotangent of the angle opposite a side."""
    f, k = side // 3, side % 3
    a, b, c = lengths[f, k], lengths[f, (k + 1) % 3], lengths[f, (k + 2) % 3]
    return (b * b + c * c - a * a) / (4.0 * triangle_area(a, b, c))


@njit(cache=True, nogil=True)
def _flip(faces: Integers, lengths: Floats, twins: Integers, side: int, twin: int) -> tuple[int, int, int, int]:
    """Replace the diagonal a b of the quadrilateral a d b c by c d; return its four outer sides."""
    f, k, g, j = side // 3, side % 3, twin // 3, twin % 3
    bc, ca, ad, db = (k + 1) % 3, (k + 2) % 3, (j + 1) % 3, (j + 2) % 3
    a, b, c, d = faces[f, k], faces[f, bc], faces[f, ca], faces[g, db]
    l_ab, l_bc, l_ca, l_ad, l_db = lengths[f, k], lengths[f, bc], lengths[f, ca], lengths[g, ad], lengths[g, db]
    x_c = (l_ab * l_ab + l_ca * l_ca - l_bc * l_bc) / (2.0 * l_ab)
    x_d = (l_ab * l_ab + l_ad * l_ad - l_db * l_db) / (2.0 * l_ab)
    height = 2.0 * (triangle_area(l_ab, l_bc, l_ca) + triangle_area(l_ab, l_ad, l_db)) / l_ab
    l_cd = np.sqrt((x_c - x_d) ** 2 + height**2)
    outer = (twins[3 * g + ad], twins[3 * f + ca], twins[3 * f + bc], twins[3 * g + db])
    own = (3 * g + ad, 3 * f + ca, 3 * f + bc, 3 * g + db)
    new = (3 * f, 3 * f + 2, 3 * g, 3 * g + 2)
    faces[f, 0], faces[f, 1], faces[f, 2] = a, d, c
    faces[g, 0], faces[g, 1], faces[g, 2] = b, c, d
    lengths[f, 0], lengths[f, 1], lengths[f, 2] = l_ad, l_cd, l_ca
    lengths[g, 0], lengths[g, 1], lengths[g, 2] = l_bc, l_cd, l_db
    twins[3 * f + 1], twins[3 * g + 1] = 3 * g + 1, 3 * f + 1
    for q in range(4):
        there = outer[q]
        for r in range(4):
            if there == own[r]:
                there = new[r]
        twins[new[q]] = there
        if there >= 0:
            twins[there] = new[q]
    return new


@njit(cache=True, nogil=True)
def triangle_area(a: float, b: float, c: float) -> float:
    """Return the area by Kahan's stable form of Heron's formula."""
    high, low = max(a, b, c), min(a, b, c)
    middle = max(min(a, b), min(max(a, b), c))
    product = (high + (middle + low)) * (low - (high - middle)) * (low + (high - middle)) * (high + (middle - low))
    return 0.25 * np.sqrt(max(product, 1e-300))


@njit(cache=True, nogil=True)
def triangle_areas(lengths: Floats) -> Floats:
    """Return the areas (m,) of triangles by their side lengths (m, 3)."""
    areas = np.empty(len(lengths))
    for f in range(len(lengths)):
        areas[f] = triangle_area(lengths[f, 0], lengths[f, 1], lengths[f, 2])
    return areas
