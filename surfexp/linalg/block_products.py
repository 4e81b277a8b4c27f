"""Products of tall blocks of eight columns, row by row: what block Lanczos does between two solves."""

from __future__ import annotations

import numpy as np
from numba import njit
from scipy.sparse import csr_array

from surfexp.contract.arrays import Floats, Integers
from surfexp.linalg.lanes import LANES, load, minus_product, plus_product, store, zero


def multiply_lanes(matrix: csr_array, block: Floats, result: Floats | None = None) -> Floats:
    """Return A X for an (n, 8) C-ordered X, faster than the general product of scipy; written to `result` if given."""
    result = np.empty((matrix.shape[0], LANES)) if result is None else result
    _multiply(matrix.indptr, matrix.indices, matrix.data, block, result)
    return result


@njit(cache=True, nogil=True)
def _multiply(indptr: Integers, indices: Integers, entries: Floats, block: Floats, result: Floats) -> None:
    for i in range(len(result)):
        total = zero()
        for p in range(indptr[i], indptr[i + 1]):
            total = plus_product(total, entries[p], load(block, indices[p]))
        store(result, i, total)


@njit(cache=True, nogil=True)
def gram(left: Floats, right: Floats) -> Floats:
    """Return X^T Y, (8, 8), of two (n, 8) C-ordered blocks."""
    a, b, c, d = zero(), zero(), zero(), zero()
    e, f, g, h = zero(), zero(), zero(), zero()
    for i in range(len(left)):
        row = load(right, i)
        a, b = plus_product(a, left[i, 0], row), plus_product(b, left[i, 1], row)
        c, d = plus_product(c, left[i, 2], row), plus_product(d, left[i, 3], row)
        e, f = plus_product(e, left[i, 4], row), plus_product(f, left[i, 5], row)
        g, h = plus_product(g, left[i, 6], row), plus_product(h, left[i, 7], row)
    result = np.empty((LANES, LANES))
    store(result, 0, a)
    store(result, 1, b)
    store(result, 2, c)
    store(result, 3, d)
    store(result, 4, e)
    store(result, 5, f)
    store(result, 6, g)
    store(result, 7, h)
    return result


@njit(cache=True, nogil=True)
def multiply_right(block: Floats, factor: Floats) -> None:
    """Overwrite an (n, 8) C-ordered block X by X F, F being (8, 8) and C-ordered."""
    for i in range(len(block)):
        total = zero()
        for k in range(LANES):
            total = plus_product(total, block[i, k], load(factor, k))
        store(block, i, total)


@njit(cache=True, nogil=True)
def subtract_product(new: Floats, here: Floats, factor: Floats) -> None:
    """Subtract here @ factor from `new` in place; blocks (n, 8), the factor (8, 8), all C-ordered."""
    for i in range(len(new)):
        total = load(new, i)
        for k in range(LANES):
            total = minus_product(total, here[i, k], load(factor, k))
        store(new, i, total)


@njit(cache=True, nogil=True)
def subtract_two(new: Floats, before: Floats, first: Floats, here: Floats, second: Floats) -> None:
    """Subtract before @ first + here @ second from `new` in place; blocks (n, 8), factors (8, 8), all C-ordered."""
    for i in range(len(new)):
        total = load(new, i)
        for k in range(LANES):
            total = minus_product(total, before[i, k], load(first, k))
            total = minus_product(total, here[i, k], load(second, k))
        store(new, i, total)


@njit(cache=True, nogil=True)
def residual_norms(errors: Floats, mass_block: Floats, values: Floats) -> Floats:
    """Return (2, 8): the 2-norms of the columns of E - M diag(values) and of M, both (n, 8) C-ordered."""
    squares = np.zeros((2, LANES))
    for i in range(len(errors)):
        for c in range(LANES):
            squares[0, c] += (errors[i, c] - values[c] * mass_block[i, c]) ** 2
            squares[1, c] += mass_block[i, c] ** 2
    return np.sqrt(squares)
