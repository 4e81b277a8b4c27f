"""Dijkstra's search from each vertex that ends with the vertices that are wanted."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats, Integers


@njit(cache=True, nogil=True)
def nearest_searches(
    starts: Integers, ends: Integers, lengths: Floats, sources: Integers, count: int
) -> tuple[Integers, Floats]:
    """Return the `count` nearest vertices of each source and their distances, (s, count), by increasing distance.

    Of equal distances the lower number comes first. The links of vertex v are those from starts[v] to starts[v + 1]; a row of
    fewer vertices ends with -1 at infinite distance.
    """
    n = len(starts) - 1
    nearest, distances = np.full((len(sources), count), -1), np.full((len(sources), count), np.inf)
    best, seen = np.full(n, np.inf), np.empty(n, np.int64)
    keys, items = np.empty(len(ends) + 1), np.empty(len(ends) + 1, np.int64)
    for row in range(len(sources)):
        size, touched, found = 1, 1, 0
        keys[0], items[0] = 0.0, sources[row]
        best[sources[row]], seen[0] = 0.0, sources[row]
        while size > 0 and found < count:
            key, vertex = keys[0], items[0]
            size -= 1
            _sink(keys, items, size)
            if key > best[vertex]:
                continue
            nearest[row, found], distances[row, found] = vertex, key
            found += 1
            for link in range(starts[vertex], starts[vertex + 1]):
                reached, end = key + lengths[link], ends[link]
                if reached < best[end]:
                    if best[end] == np.inf:
                        seen[touched] = end
                        touched += 1
                    best[end] = reached
                    _rise(keys, items, size, reached, end)
                    size += 1
        for place in range(touched):
            best[seen[place]] = np.inf
    return nearest, distances


@njit(cache=True, nogil=True)
def _before(key: float, item: int, other_key: float, other: int) -> bool:
    return key < other_key or (key == other_key and item < other)


@njit(cache=True, nogil=True)
def _rise(keys: Floats, items: Integers, size: int, key: float, item: int) -> None:
    """Put an entry into a heap of `size`."""
    place = size
    while place > 0:
        parent = (place - 1) // 2
        if not _before(key, item, keys[parent], items[parent]):
            break
        keys[place], items[place] = keys[parent], items[parent]
        place = parent
    keys[place], items[place] = key, item


@njit(cache=True, nogil=True)
def _sink(keys: Floats, items: Integers, size: int) -> None:
    """Take the top of a heap out: its last entry, number `size`, sinks from there."""
    key, item, place = keys[size], items[size], 0
    while 2 * place + 1 < size:
        child = 2 * place + 1
        if child + 1 < size and _before(keys[child + 1], items[child + 1], keys[child], items[child]):
            child += 1
        if not _before(keys[child], items[child], key, item):
            break
        keys[place], items[place] = keys[child], items[child]
        place = child
    keys[place], items[place] = key, item
