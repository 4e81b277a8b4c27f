"""Triangular solves with supernodal panels for one right-hand side."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats, Integers
from surfexp.linalg.lanes import LANES, load, plus_lanes, plus_product, store, total, zero
from surfexp.linalg.ldlt_front import padded


@njit(cache=True, nogil=True, fastmath={"contract", "reassoc"})
def solve_one(
    columns: Integers, row_starts: Integers, rows: Integers, panels: Integers, factor: Floats, pivots: Floats, x: Floats
) -> None:
    """Overwrite the (n,) right-hand side `x`, in elimination order, by the solution of L D L^T x = b.

    Parameters
    ----------
    columns, row_starts, rows, panels, factor, pivots
        As in `ldlt_solve.solve_lanes`.
    """
    most = 0
    for s in range(len(columns) - 1):
        most = max(most, row_starts[s + 1] - row_starts[s])
    products = np.zeros((padded(most) // LANES, LANES))
    lanes = factor.reshape(-1, LANES)
    for s in range(len(columns) - 1):
        start, width = columns[s], columns[s + 1] - columns[s]
        for i in range(1, width):
            at = panels[s] + i * width
            known = 0.0
            for j in range(i):
                known += factor[at + j] * x[start + j]
            x[start + i] -= known
        below = rows[row_starts[s] : row_starts[s + 1]]
        at = (panels[s] + padded(width * width)) // LANES
        multiply(lanes, at, width, x[start : start + width], products, padded(len(below)) // LANES)
        for t in range(len(below)):
            x[below[t]] -= products[t // LANES, t % LANES]
    for i in range(len(pivots)):
        x[i] /= pivots[i]
    for s in range(len(columns) - 2, -1, -1):
        start, width = columns[s], columns[s + 1] - columns[s]
        below = rows[row_starts[s] : row_starts[s + 1]]
        groups = padded(len(below)) // LANES
        for t in range(len(below)):
            products[t // LANES, t % LANES] = x[below[t]]
        for t in range(len(below), groups * LANES):
            products[t // LANES, t % LANES] = 0.0
        at = (panels[s] + padded(width * width)) // LANES
        subtract_transposed(lanes, at, width, products, groups, x[start : start + width])
        for i in range(width - 1, 0, -1):
            at = panels[s] + i * width
            value = x[start + i]
            for j in range(i):
                x[start + j] -= factor[at + j] * value


@njit(cache=True, nogil=True)
def multiply(lanes: Floats, at: int, width: int, x: Floats, products: Floats, groups: int) -> None:
    """Write the products of a panel's rows, `groups` times eight from `at` on, with x into `products`; two groups at once."""
    pairs = groups - groups % 2
    for g in range(0, pairs, 2):
        a, b = zero(), zero()
        for j in range(width):
            a = plus_product(a, x[j], load(lanes, at + j))
            b = plus_product(b, x[j], load(lanes, at + width + j))
        store(products, g, a)
        store(products, g + 1, b)
        at += 2 * width
    if pairs < groups:
        a = zero()
        for j in range(width):
            a = plus_product(a, x[j], load(lanes, at + j))
        store(products, pairs, a)


@njit(cache=True, nogil=True)
def subtract_transposed(lanes: Floats, at: int, width: int, values: Floats, groups: int, x: Floats) -> None:
    """Subtract the products of a panel's columns with `values` from x, four columns at once."""
    fours = width - width % 4
    for j in range(0, fours, 4):
        a, b, c, d = zero(), zero(), zero(), zero()
        for g in range(groups):
            value, entry = load(values, g), at + g * width + j
            a = plus_lanes(a, value, load(lanes, entry))
            b = plus_lanes(b, value, load(lanes, entry + 1))
            c = plus_lanes(c, value, load(lanes, entry + 2))
            d = plus_lanes(d, value, load(lanes, entry + 3))
        x[j] -= total(a)
        x[j + 1] -= total(b)
        x[j + 2] -= total(c)
        x[j + 3] -= total(d)
    for j in range(fours, width):
        a = zero()
        for g in range(groups):
            a = plus_lanes(a, load(values, g), load(lanes, at + g * width + j))
        x[j] -= total(a)
