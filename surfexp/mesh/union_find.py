"""Disjoint sets in compiled loops."""

from __future__ import annotations

from numba import njit

from surfexp.contract.arrays import Integers


@njit(cache=True, nogil=True)
def find_root(parents: Integers, item: int) -> int:
    """Return the root of an item's set, halving the path to it (Tarjan and van Leeuwen 1984); a root is its own parent."""
    while parents[item] != item:
        parents[item] = parents[parents[item]]
        item = parents[item]
    return item
