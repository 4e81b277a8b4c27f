"""Minimum-degree order of the small pieces that nested dissection leaves."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Integers

LARGEST_HALO = 160


@njit(cache=True, nogil=True)
def order_leaf(indptr: Integers, indices: Integers, members: Integers, local: Integers) -> None:
    """Sort `members` in place by exact minimum degree on the elimination graph.

    The separator vertices around the piece are eliminated later but count in the degrees (halo minimum degree, Pellegrini
    et al. 2000), unless there are more than 160 of them.

    Parameters
    ----------
    indptr, indices : int64 arrays
        Compressed rows of the whole graph.
    members : int64 array
        The vertices of the piece.
    local : (n,) int64
        Scratch, -1 everywhere before and after.
    """
    count = len(members)
    nodes = np.empty(count + LARGEST_HALO, np.int64)
    size = count
    for a in range(count):
        nodes[a] = members[a]
        local[members[a]] = a
    for a in range(count):
        for at in range(indptr[members[a]], indptr[members[a] + 1]):
            u = indices[at]
            if local[u] == -1 and size < len(nodes):
                nodes[size] = u
                local[u] = size
                size += 1
    if size == len(nodes):
        for a in range(count, size):
            local[nodes[a]] = -1
        size = count
    joined = np.zeros((size, size), np.bool_)
    for a in range(size):
        for at in range(indptr[nodes[a]], indptr[nodes[a] + 1]):
            b = local[indices[at]]
            if b >= 0 and b != a:
                joined[a, b] = True
    _eliminate(joined, count, nodes, members)
    for a in range(size):
        local[nodes[a]] = -1


@njit(cache=True, nogil=True)
def _eliminate(joined: np.ndarray, count: int, nodes: Integers, members: Integers) -> None:
    size = len(joined)
    degree = np.zeros(size, np.int64)
    for a in range(size):
        for b in range(size):
            degree[a] += joined[a, b]
    done = np.zeros(count, np.bool_)
    ring = np.empty(size, np.int64)
    for step in range(count):
        best = -1
        for a in range(count):
            if not done[a] and (best < 0 or degree[a] < degree[best]):
                best = a
        done[best] = True
        members[step] = nodes[best]
        neighbours = 0
        for b in range(size):
            if joined[best, b]:
                joined[b, best] = False
                degree[b] -= 1
                ring[neighbours] = b
                neighbours += 1
        for s in range(neighbours):
            for t in range(s + 1, neighbours):
                a, b = ring[s], ring[t]
                if not joined[a, b]:
                    joined[a, b] = joined[b, a] = True
                    degree[a] += 1
                    degree[b] += 1
