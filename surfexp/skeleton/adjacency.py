"""Which side of which face lies across each side, and where a surface is pinched to a point."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from surfexp.contract.arrays import Integers
from surfexp.mesh.triangle_mesh import TriangleMesh

Flags = NDArray[np.bool_]


def opposite_sides(mesh: TriangleMesh) -> Integers:
    """Side 3 g + l of the other face at side 3 f + k, which joins corners k and k + 1; -1 on the boundary.

    Returns
    -------
    (3 m,) int64

    Raises
    ------
    ValueError
        If three faces meet at an edge.
    """
    table = mesh.edge_table
    if len(crowded := np.flatnonzero(table.counts > 2)):
        a, b = table.edges[crowded[0]]
        raise ValueError(
            f"the edge between vertices {a} and {b} has {table.counts[crowded[0]]} faces, at most 2 are allowed: "
            "surfexp repair keeps two of them"
        )
    first = table.starts[:-1][table.counts == 2]
    one, other = table.half_edges[first], table.half_edges[first + 1]
    twins = np.full(len(table.half_edges), -1, dtype=np.int64)
    twins[one], twins[other] = other, one
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
