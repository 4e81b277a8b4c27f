"""Vertex separators of a piece of a graph: a first cut by distances, then local improvement."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.mesh.triangle_mesh import Integers

SEPARATOR = 2
HEAVIEST = 0.6
PASSES = 6


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
    for v in members:
        if side[v] == SEPARATOR:
            border[sizes[SEPARATOR]] = v
        sizes[side[v]] += 1
    for _ in range(PASSES):
        before = sizes[SEPARATOR]
        _improve(indptr, indices, piece, label, side, ties, locked, sizes, border)
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
) -> None:
    """One pass; `border` lists the separator before and after."""
    count = sizes[SEPARATOR]
    for at in range(count):
        _count_ties(indptr, indices, border[at], piece, label, side, ties)
    heaviest = int(HEAVIEST * sizes.sum())
    best_size, best_weight, best_length = sizes[SEPARATOR], max(sizes[0], sizes[1]), 0
    patience = 30 + best_size // 4
    trail = [(0, 0) for _ in range(0)]
    since = 0
    while since < patience:
        at, to = _best_move(border, count, ties, locked, sizes, heaviest)
        if at < 0:
            break
        v, other = border[at], 1 - to
        count -= 1
        border[at] = border[count]
        _relabel(v, to, side, sizes, trail)
        locked[v] = True
        for p in range(indptr[v], indptr[v + 1]):
            u = indices[p]
            if piece[u] != label or u == v:
                continue
            if side[u] == SEPARATOR:
                ties[u, to] += 1
            elif side[u] == other:
                _relabel(u, SEPARATOR, side, sizes, trail)
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
            best_size, best_weight, best_length = sizes[SEPARATOR], weight, len(trail)
    _rewind(best_length, side, sizes, trail, locked, border, count)


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
def _relabel(v: int, to: int, side: Integers, sizes: Integers, trail: list[tuple[int, int]]) -> None:
    trail.append((v, int(side[v])))
    sizes[side[v]] -= 1
    sizes[to] += 1
    side[v] = to


@njit(cache=True, nogil=True)
def _rewind(
    length: int,
    side: Integers,
    sizes: Integers,
    trail: list[tuple[int, int]],
    locked: Integers,
    border: Integers,
    count: int,
) -> None:
    candidates = [border[a] for a in range(count)]
    while len(trail) > length:
        v, was = trail.pop()
        sizes[side[v]] -= 1
        sizes[was] += 1
        side[v] = was
        locked[v] = False
        candidates.append(v)
    for v, _ in trail:
        locked[v] = False
    size = 0
    for v in candidates:
        if side[v] == SEPARATOR and not locked[v]:
            locked[v] = True
            border[size] = v
            size += 1
    for a in range(size):
        locked[border[a]] = False
