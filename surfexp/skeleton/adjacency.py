"""Which side of which face lies across each side, and where a surface is pinched to a point."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from surfexp.contract.arrays import Integers
from surfexp.mesh.vertex_star import vertex_stars

Flags = NDArray[np.bool_]


def opposite_sides(faces: Integers, vertex_count: int) -> Integers:
    """Side 3 g + l of the other face at side 3 f + k, which joins corners k and k + 1; -1 on the boundary.

    Parameters
    ----------
    faces : (m, 3) int64
    vertex_count : int

    Returns
    -------
    (3 m,) int64

    Raises
    ------
    ValueError
        If three faces meet at an edge.
    """
    start, star = vertex_stars(faces, vertex_count)
    twins, bad = _opposite(faces, start, star)
    if bad >= 0:
        a, b = faces[bad // 3, bad % 3], faces[bad // 3, (bad + 1) % 3]
        raise ValueError(
            f"the edge between vertices {a} and {b} has 3 faces or more, at most 2 are allowed: "
            "surfexp repair divides the surface there"
        )
    return twins


@njit(cache=True, nogil=True)
def pinched_vertices(faces: Integers, twins: Integers, start: Integers, star: Integers) -> Flags:
    """(n,) whether the faces around a vertex form several fans that have only the vertex in common (a bow-tie).

    Parameters
    ----------
    faces : (m, 3) int64
    twins : (3 m,) int64
        As by `opposite_sides`.
    start, star
        As by `vertex_stars`.
    """
    pinched = np.zeros(len(start) - 1, np.bool_)
    for v in range(len(start) - 1):
        if start[v] == start[v + 1]:
            continue
        first, reached = star[start[v]], 1
        # the fan of the first face, both ways; a closed one ends where it began
        for way in range(2):
            f, onward = first, -1
            for k in range(3):
                if faces[f, k] == v:
                    onward = 3 * f + (k if way == 0 else (k + 2) % 3)
            while twins[onward] >= 0 and twins[onward] // 3 != first:
                onward = _other_side(faces, twins[onward], v)
                reached += 1
            if twins[onward] >= 0:
                break
        pinched[v] = reached < start[v + 1] - start[v]
    return pinched


@njit(cache=True, nogil=True)
def _other_side(faces: Integers, side: int, v: int) -> int:
    """The other side of the same face at vertex v."""
    f = side // 3
    for k in range(3):
        if 3 * f + k != side and (faces[f, k] == v or faces[f, (k + 1) % 3] == v):
            return 3 * f + k
    return -1


@njit(cache=True, nogil=True)
def _opposite(faces: Integers, start: Integers, star: Integers) -> tuple[Integers, int]:
    twins = np.full(faces.size, -1, np.int64)
    for f in range(len(faces)):
        for k in range(3):
            a, b = faces[f, k], faces[f, (k + 1) % 3]
            for at in range(start[a], start[a + 1]):
                g = star[at]
                if g == f:
                    continue
                for j in range(3):
                    c, d = faces[g, j], faces[g, (j + 1) % 3]
                    if (c == a and d == b) or (c == b and d == a):
                        if twins[3 * f + k] >= 0:
                            return twins, 3 * f + k
                        twins[3 * f + k] = 3 * g + j
    return twins, -1
