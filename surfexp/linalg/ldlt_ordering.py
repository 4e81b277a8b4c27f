"""Nested dissection: an elimination order that keeps the factors of a sparse symmetric matrix small."""

from __future__ import annotations

import numpy as np
from numba import njit
from scipy.sparse import csr_array
from scipy.sparse.csgraph import reverse_cuthill_mckee

from surfexp.contract.arrays import Integers
from surfexp.linalg.ldlt_bisection import POLES, SEPARATOR, bisect, forget_distances, measure_distances
from surfexp.linalg.ldlt_leaf import order_leaf
from surfexp.linalg.ldlt_separator import refine

LEAF_SIZE = 48
LARGE_PIECE = 600


def nested_dissection(indptr: Integers, indices: Integers) -> Integers:
    """Order the vertices of a graph by nested dissection (George 1973).

    A graph is cut by a small vertex separator that is eliminated last; both sides are ordered in the same way. The cut
    begins at the bisector of two far-apart vertices, where their graph distances are equal (on a triangulated surface a
    nearly straight line), and is shortened by Fiduccia-Mattheyses moves (1982). Pieces of at most 48 vertices are ordered
    by minimum degree, with the separators around them in view.

    Parameters
    ----------
    indptr, indices : int64 arrays
        Compressed rows of the graph; symmetric pattern, entries on the diagonal are ignored.

    Returns
    -------
    (n,) int64
        The vertex that is eliminated first, second, ...; the same at every call.
    """
    graph = csr_array((np.ones(len(indices), np.int8), indices, indptr), shape=(len(indptr) - 1, len(indptr) - 1))
    # neighbours near in memory: the searches below take half the time
    nearby = reverse_cuthill_mckee(graph, symmetric_mode=True)
    graph = csr_array(graph[nearby][:, nearby])
    order = _dissect(graph.indptr.astype(np.int32), graph.indices.astype(np.int32), LEAF_SIZE)
    return nearby[order].astype(np.int64)


@njit(cache=True, nogil=True)
def _dissect(indptr: Integers, indices: Integers, leaf_size: int) -> Integers:
    n = len(indptr) - 1
    order = np.arange(n)
    # which piece a vertex belongs to now; separators and finished leaves leave all pieces
    piece = np.zeros(n, np.int32)
    local = np.full(n, -1, np.int64)
    level = np.zeros((POLES, n), np.int32)
    side = np.zeros(n, np.int8)
    ties = np.zeros((n, 2), np.int64)
    locked = np.zeros(n, np.bool_)
    # first and last place of a piece in the order, and its label
    pending = np.empty((n + 1, 3), np.int64)
    pending[0, 0], pending[0, 1], pending[0, 2] = 0, n, 0
    waiting, pieces = 1, 1
    counts, starts = np.zeros(3, np.int64), np.zeros(3, np.int64)
    while waiting > 0:
        waiting -= 1
        low, high, label = pending[waiting, 0], pending[waiting, 1], pending[waiting, 2]
        if high - low <= leaf_size:
            order_leaf(indptr, indices, order[low:high], local)
            for at in range(low, high):
                piece[order[at]] = -1
            continue
        members = order[low:high].copy()
        _separate(indptr, indices, members, piece, label, level, side, ties, locked)
        counts[0], counts[1], counts[2] = 0, 0, 0
        for v in members:
            counts[side[v]] += 1
        starts[0], starts[1], starts[2] = low, low + counts[0], low + counts[0] + counts[1]
        for v in members:
            order[starts[side[v]]] = v
            starts[side[v]] += 1
            piece[v] = pieces + side[v] if side[v] < SEPARATOR else -1
        for part in range(2):
            pending[waiting, 0], pending[waiting, 1] = starts[part] - counts[part], starts[part]
            pending[waiting, 2] = pieces + part
            waiting += 1
        pieces += 2
    return order


@njit(cache=True, nogil=True)
def _separate(
    indptr: Integers,
    indices: Integers,
    members: Integers,
    piece: Integers,
    label: int,
    level: Integers,
    side: Integers,
    ties: Integers,
    locked: Integers,
) -> None:
    """Write the shortest separator of a few attempts to `side`; the parts of a piece in several parts need none."""
    large = len(members) >= LARGE_PIECE
    if not measure_distances(indptr, indices, members, level, POLES if large else 2):
        for v in members:
            side[v] = 0 if level[0, v] >= 0 else 1
        forget_distances(members, level)
        return
    shortest = len(members) + 1
    best = np.empty(len(members), np.int8)
    for attempt in range(3 if large else 1):
        cut = bisect(indptr, indices, members, piece, label, level, side, attempt)
        cut = refine(indptr, indices, members, piece, label, side, ties, locked)
        if cut < shortest:
            shortest = cut
            for a in range(len(members)):
                best[a] = side[members[a]]
    forget_distances(members, level)
    for a in range(len(members)):
        side[members[a]] = best[a]
