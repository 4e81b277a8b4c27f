"""Disjoint sets in compiled loops."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Integers


@njit(cache=True, nogil=True)
def find_root(parents: Integers, item: int) -> int:
    """Return the root of an item's set, halving the path to it (Tarjan and van Leeuwen 1984); a root is its own parent."""
    while parents[item] != item:
        parents[item] = parents[parents[item]]
        item = parents[item]
    return item


@njit(cache=True, nogil=True)
def join(parents: Integers, one: int, other: int) -> None:
    """Unite the sets of two items; the root of a set is its smallest item."""
    a, b = find_root(parents, one), find_root(parents, other)
    parents[max(a, b)] = min(a, b)


@njit(cache=True, nogil=True)
def numbered_sets(parents: Integers) -> Integers:
    """Return the number of each item's set, from 0, in the order of their smallest items, which are the roots."""
    numbers, found = np.empty(len(parents), np.int64), 0
    for item in range(len(parents)):
        root = find_root(parents, item)
        if root == item:
            numbers[item] = found
            found += 1
        else:
            numbers[item] = numbers[root]
    return numbers


@njit(cache=True, nogil=True)
def components(links: Integers, count: int) -> Integers:
    """Return the number of the connected component of each of `count` items, from 0, in the order of their first items.

    Parameters
    ----------
    links : (k, 2) int64
    count : int
    """
    parents = np.arange(count)
    for i in range(len(links)):
        join(parents, links[i, 0], links[i, 1])
    return numbered_sets(parents)
