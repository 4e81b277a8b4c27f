"""Rows that equal an earlier row, by hashing: no step compares the order of rows."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from surfexp.contract.arrays import Integers


def first_equal_row(rows: NDArray[Any]) -> Integers:
    """Return for each row the first one that equals it: its own number where there is none before it.

    Parameters
    ----------
    rows : (k, c) of numbers
        Zero equals minus zero, and NaN itself.

    Returns
    -------
    (k,) int64
    """
    words = np.ascontiguousarray(rows, dtype=np.float64 if rows.dtype.kind == "f" else np.int64) + 0
    return np.asarray(_first_equal(words.view(np.uint64)))


def later_copies(rows: NDArray[Any]) -> NDArray[np.bool_]:
    """Return which rows (k, c), as `first_equal_row` takes them, equal an earlier one."""
    return first_equal_row(rows) != np.arange(len(rows))


@njit(cache=True, nogil=True)
def _first_equal(bits: NDArray[np.uint64]) -> Integers:
    size = 2
    while size < 2 * len(bits):
        size *= 2
    slots, first = np.full(size, -1, np.int64), np.empty(len(bits), np.int64)
    for row in range(len(bits)):
        # the finaliser of splitmix64 (Steele, Lea and Flood 2014) after each word
        word = np.uint64(0)
        for column in range(bits.shape[1]):
            word = (word ^ bits[row, column]) * np.uint64(0xBF58476D1CE4E5B9)
            word = (word ^ (word >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
            word = word ^ (word >> np.uint64(31))
        slot = np.int64(word & np.uint64(size - 1))
        while slots[slot] >= 0 and not _equal(bits, slots[slot], row):
            slot = (slot + 1) & (size - 1)
        if slots[slot] < 0:
            slots[slot] = row
        first[row] = slots[slot]
    return first


@njit(cache=True, nogil=True)
def _equal(bits: NDArray[np.uint64], one: int, other: int) -> bool:
    same = True
    for column in range(bits.shape[1]):
        same &= bits[one, column] == bits[other, column]
    return same
