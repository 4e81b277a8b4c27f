"""Which side of which face lies across each side."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.mesh.triangle_mesh import Integers
from surfexp.mesh.vertex_star import vertex_stars


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
        raise ValueError(f"the edge between vertices {a} and {b} has 3 faces or more, at most 2 are allowed: repair it")
    return twins


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
