"""A first cut of a piece of a graph in two, by distances."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Integers

SEPARATOR = 2
POLES = 4


@njit(cache=True, nogil=True)
def measure_distances(indptr: Integers, indices: Integers, members: Integers, level: Integers, poles: int) -> bool:
    """Write distances inside a piece to `level`: from two far-apart vertices, and from two across from them.

    Parameters
    ----------
    level : (4, n) int32
        0 before, so that searches go nowhere but to the vertices that are opened here; see `forget_distances`.
    poles : int
        2 or 4 of the four.

    Returns
    -------
    bool
        Whether the piece is connected. If not, row 0 is -1 where its first vertex does not reach.
    """
    queue = np.empty(len(members), np.int32)
    for pole in range(poles):
        for v in members:
            level[pole, v] = -1
    if _distances(indptr, indices, int(members[0]), level[0], queue) < len(members):
        return False
    start = int(queue[-1])
    for v in members:
        level[0, v] = -1
    _distances(indptr, indices, start, level[0], queue)
    _distances(indptr, indices, int(queue[-1]), level[1], queue)
    if poles == POLES:
        across = members[0]
        for v in members:
            if min(level[0, v], level[1, v]) > min(level[0, across], level[1, across]):
                across = v
        _distances(indptr, indices, across, level[2], queue)
        _distances(indptr, indices, int(queue[-1]), level[3], queue)
    return True


@njit(cache=True, nogil=True)
def forget_distances(members: Integers, level: Integers) -> None:
    """Set `level` to 0 again."""
    for pole in range(POLES):
        for v in members:
            level[pole, v] = 0


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
    """Split a connected piece into sides 0 and 1 and a separator 2, written to `side`; return the separator's size.

    Half the vertices, those nearer to one of two far-apart vertices than to the other, are side 0; of the rest those
    that touch side 0 are the separator. Attempt 0 takes the first pair, attempt 1 the pair across from it, attempt 2 the
    distance from one of the first pair alone.
    """
    near, far = (2, 3) if attempt == 1 else (0, 1)
    keys = np.empty(len(members), np.int64)
    lowest, highest = len(level[0]), -len(level[0])
    for a in range(len(members)):
        keys[a] = level[near, members[a]] - (level[far, members[a]] if attempt < 2 else 0)
        lowest, highest = min(lowest, keys[a]), max(highest, keys[a])
    counts = np.zeros(highest - lowest + 1, np.int64)
    for key in keys:
        counts[key - lowest] += 1
    left = (len(members) + 1) // 2
    middle = lowest
    while counts[middle - lowest] <= left:
        left -= counts[middle - lowest]
        middle += 1
    for a in range(len(members)):
        nearer = keys[a] < middle
        if keys[a] == middle and left > 0:
            left -= 1
            nearer = True
        side[members[a]] = 0 if nearer else 1
    return _cover(indptr, indices, members, piece, label, side)


@njit(cache=True, nogil=True)
def _distances(indptr: Integers, indices: Integers, start: int, level: Integers, queue: Integers) -> int:
    """Breadth-first distances from `start` to the vertices at -1; returns how many it reaches."""
    queue[0] = start
    level[start] = 0
    head, tail = 0, 1
    while head < tail:
        v = queue[head]
        head += 1
        for at in range(indptr[v], indptr[v + 1]):
            u = indices[at]
            if level[u] < 0:
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
