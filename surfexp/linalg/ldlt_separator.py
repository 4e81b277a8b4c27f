"""Shorter vertex separators by local improvement."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Integers
from surfexp.linalg.ldlt_bisection import SEPARATOR

HEAVIEST = 0.6
PASSES = 6


@njit(cache=True, nogil=True)
def refine(
    indptr: Integers,
    indices: Integers,
    members: Integers,
    piece: Integers,
    label: int,
    side: Integers,
    ties: Integers,
    locked: Integers,
) -> int:
    """Shorten a separator by Fiduccia-Mattheyses passes, in place, until one pass finds nothing.

    A move takes a separator vertex to a side and pulls its neighbours on the other side in. A pass makes the best move,
    even a bad one, moves no vertex twice, and is wound back to its best moment.

    Parameters
    ----------
    ties : (n, 2) int64
        Scratch: neighbours of a separator vertex on the two sides.
    locked : (n,) bool
        Scratch, False everywhere before and after.

    Returns
    -------
    int
        The size of the separator.
    """
    sizes = np.zeros(3, np.int64)
    border = np.empty(len(members), np.int64)
    # a vertex is pulled in once and moved once in a pass
    trail = np.empty((2 * len(members), 2), np.int64)
    for v in members:
        if side[v] == SEPARATOR:
            border[sizes[SEPARATOR]] = v
        sizes[side[v]] += 1
    for _ in range(PASSES):
        before = sizes[SEPARATOR]
        _improve(indptr, indices, piece, label, side, ties, locked, sizes, border, trail)
        if sizes[SEPARATOR] == before:
            break
    return sizes[SEPARATOR]


@njit(cache=True, nogil=True)
def _improve(
    indptr: Integers,
    indices: Integers,
    piece: Integers,
    label: int,
    side: Integers,
    ties: Integers,
    locked: Integers,
    sizes: Integers,
    border: Integers,
    trail: Integers,
) -> None:
    """One pass; `border` lists the separator before and after."""
    count = sizes[SEPARATOR]
    for at in range(count):
        _count_ties(indptr, indices, border[at], piece, label, side, ties)
    heaviest = int(HEAVIEST * (sizes[0] + sizes[1] + sizes[2]))
    best_size, best_weight, best_length = sizes[SEPARATOR], max(sizes[0], sizes[1]), 0
    patience = 30 + best_size // 4
    since, length = 0, 0
    while since < patience:
        at, to = _best_move(border, count, ties, locked, sizes, heaviest)
        if at < 0:
            break
        v, other = border[at], 1 - to
        count -= 1
        border[at] = border[count]
        length = _relabel(v, to, side, sizes, trail, length)
        locked[v] = True
        for p in range(indptr[v], indptr[v + 1]):
            u = int(indices[p])
            if piece[u] != label or u == v:
                continue
            if side[u] == SEPARATOR:
                ties[u, to] += 1
            elif side[u] == other:
                length = _relabel(u, SEPARATOR, side, sizes, trail, length)
                _count_ties(indptr, indices, u, piece, label, side, ties)
                border[count] = u
                count += 1
                for q in range(indptr[u], indptr[u + 1]):
                    w = indices[q]
                    if piece[w] == label and side[w] == SEPARATOR and w != u:
                        ties[w, other] -= 1
        weight = max(sizes[0], sizes[1])
        since += 1
        if sizes[SEPARATOR] < best_size or (sizes[SEPARATOR] == best_size and weight < best_weight):
            if sizes[SEPARATOR] < best_size:
                since = 0
            best_size, best_weight, best_length = sizes[SEPARATOR], weight, length
    _rewind(best_length, side, sizes, trail[:length], locked, border, count)


@njit(cache=True, nogil=True)
def _count_ties(
    indptr: Integers, indices: Integers, v: int, piece: Integers, label: int, side: Integers, ties: Integers
) -> None:
    ties[v, 0] = ties[v, 1] = 0
    for p in range(indptr[v], indptr[v + 1]):
        u = indices[p]
        if piece[u] == label and side[u] != SEPARATOR:
            ties[v, side[u]] += 1


@njit(cache=True, nogil=True)
def _best_move(
    border: Integers, count: int, ties: Integers, locked: Integers, sizes: Integers, heaviest: int
) -> tuple[int, int]:
    """Place in `border` and side of the move that adds least to the separator; ties go to the lighter side."""
    best, at, to = 1 << 60, -1, 0
    light = 0 if sizes[0] <= sizes[1] else 1
    for a in range(count):
        v = border[a]
        if locked[v]:
            continue
        for choice in range(2):
            target = light if choice == 0 else 1 - light
            if ties[v, 1 - target] < best and (target == light or sizes[target] < heaviest):
                best, at, to = ties[v, 1 - target], a, target
    return at, to


@njit(cache=True, nogil=True)
def _relabel(v: int, to: int, side: Integers, sizes: Integers, trail: Integers, length: int) -> int:
    """Write the move behind the `length` moves of the trail; return its new length."""
    trail[length, 0], trail[length, 1] = v, side[v]
    sizes[side[v]] -= 1
    sizes[to] += 1
    side[v] = to
    return length + 1


@njit(cache=True, nogil=True)
def _rewind(
    length: int,
    side: Integers,
    sizes: Integers,
    trail: Integers,
    locked: Integers,
    border: Integers,
    count: int,
) -> None:
    candidates = np.empty(count + len(trail) - length, np.int64)
    for a in range(count):
        candidates[a] = border[a]
    for move in range(len(trail) - 1, length - 1, -1):
        v, was = trail[move, 0], trail[move, 1]
        sizes[side[v]] -= 1
        sizes[was] += 1
        side[v] = was
        locked[v] = False
        candidates[count] = v
        count += 1
    for move in range(length):
        locked[trail[move, 0]] = False
    size = 0
    for v in candidates:
        if side[v] == SEPARATOR and not locked[v]:
            locked[v] = True
            border[size] = v
            size += 1
    for a in range(size):
        locked[border[a]] = False
