"""A first cut of a piece of a graph in two, by distances."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.mesh.triangle_mesh import Integers

SEPARATOR = 2


@njit(cache=True, nogil=True)
def bisect(
    indptr: Integers,
    indices: Integers,
    members: Integers,
    piece: Integers,
    label: int,
    level: Integers,
    side: Integers,
    attempt: int,
) -> int:
    """Split a piece into sides 0 and 1 and a separator 2, written to `side`.

    Half the vertices, those nearer to one of two far-apart vertices than to the other, are side 0; of the rest those
    that touch side 0 are the separator. The parts of a piece that is not connected need none. Attempt 0 takes a pair of
    farthest vertices, attempt 1 a pair across from them, attempt 2 the distance from one of the first pair alone.

    Returns
    -------
    int
        The size of the separator.
    """
    queue = np.empty(len(members), np.int64)
    reached = _distances(indptr, indices, members[0], piece, label, level[:, 0], queue)
    if reached < len(members):
        for v in members:
            side[v] = 0 if level[v, 0] >= 0 else 1
            level[v, 0] = -1
        return 0
    start = queue[reached - 1]
    _clear(level[:, 0], members)
    _distances(indptr, indices, start, piece, label, level[:, 0], queue)
    end = queue[reached - 1]
    if attempt < 2:
        _distances(indptr, indices, end, piece, label, level[:, 1], queue)
    if attempt == 1:
        across = members[0]
        for v in members:
            if min(level[v, 0], level[v, 1]) > min(level[across, 0], level[across, 1]):
                across = v
        _clear(level[:, 0], members)
        _clear(level[:, 1], members)
        _distances(indptr, indices, across, piece, label, level[:, 0], queue)
        _distances(indptr, indices, queue[reached - 1], piece, label, level[:, 1], queue)
    keys = np.empty(len(members), np.int64)
    for a in range(len(members)):
        keys[a] = level[members[a], 0] - level[members[a], 1]
    by_key = np.argsort(keys, kind="mergesort")
    for rank in range(len(members)):
        side[members[by_key[rank]]] = 0 if 2 * rank < len(members) else 1
    _clear(level[:, 0], members)
    _clear(level[:, 1], members)
    return _cover(indptr, indices, members, piece, label, side)


@njit(cache=True, nogil=True)
def _clear(level: Integers, members: Integers) -> None:
    for v in members:
        level[v] = -1


@njit(cache=True, nogil=True)
def _distances(
    indptr: Integers, indices: Integers, start: int, piece: Integers, label: int, level: Integers, queue: Integers
) -> int:
    """Breadth-first distances from `start` inside the piece; returns how many vertices it reaches."""
    queue[0] = start
    level[start] = 0
    head, tail = 0, 1
    while head < tail:
        v = queue[head]
        head += 1
        for at in range(indptr[v], indptr[v + 1]):
            u = indices[at]
            if piece[u] == label and level[u] < 0:
                level[u] = level[v] + 1
                queue[tail] = u
                tail += 1
    return tail


@njit(cache=True, nogil=True)
def _cover(indptr: Integers, indices: Integers, members: Integers, piece: Integers, label: int, side: Integers) -> int:
    count = 0
    for v in members:
        if side[v] == 1:
            for at in range(indptr[v], indptr[v + 1]):
                if piece[indices[at]] == label and side[indices[at]] == 0:
                    side[v] = SEPARATOR
                    count += 1
                    break
    return count
