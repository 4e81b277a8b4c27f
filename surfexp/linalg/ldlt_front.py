"""Dense elimination of the columns of one front, and what it takes off the rest."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats
from surfexp.linalg.lanes import LANES, load, load_part, minus_product, store, store_part

COLUMNS_AT_ONCE = 32
ROWS_AT_ONCE = 96
SMALL_UPDATE = 600


@njit(cache=True, nogil=True)
def padded(count: int) -> int:
    """Return how many entries a row of an update has, so that it is made of whole lanes."""
    return (count + LANES - 1) // LANES * LANES


@njit(cache=True, nogil=True, fastmath={"contract"}, error_model="numpy")
def eliminate_front(panel: Floats, pivots: Floats, smallest: float, update: Floats) -> int:
    """Factorise the columns of a front in place and subtract their products from the rest of it."""
    height, width = panel.shape
    replaced = 0
    for low in range(0, width, COLUMNS_AT_ONCE):
        high = min(width, low + COLUMNS_AT_ONCE)
        replaced += eliminate_block(panel, low, high, pivots, smallest)
        solve_rows(panel, low, high, pivots)
        if high < width:
            subtract_products(panel[high:, low:high], pivots[low:high], panel[high:, high:])
    if height > width:
        subtract_square(panel[width:], pivots, update)
    return replaced


@njit(cache=True, nogil=True, fastmath={"contract"}, error_model="numpy")
def eliminate_block(panel: Floats, low: int, high: int, pivots: Floats, smallest: float) -> int:
    """Factorise a diagonal block; returns how many pivots were replaced."""
    transposed = np.zeros((high - low, high - low))
    replaced = 0
    for k in range(low, high):
        pivot = panel[k, k]
        if abs(pivot) < smallest:
            pivot = smallest if pivot >= 0.0 else -smallest
            replaced += 1
        pivots[k] = pivot
        for i in range(k + 1, high):
            transposed[k - low, i - low] = panel[i, k] / pivot
        for i in range(k + 1, high):
            entry = panel[i, k]
            for j in range(k + 1, i + 1):
                panel[i, j] -= entry * transposed[k - low, j - low]
            panel[i, k] = transposed[k - low, i - low]
    return replaced


@njit(cache=True, nogil=True)
def solve_rows(panel: Floats, low: int, high: int, pivots: Floats) -> None:
    """Multiply the rows below a diagonal block by L^-T D^-1, eight rows at a time."""
    width = high - low
    turned = np.zeros((width, LANES))
    for first in range(high, len(panel), LANES):
        last = min(first + LANES, len(panel))
        for i in range(first, last):
            for k in range(width):
                turned[k, i - first] = panel[i, low + k]
        for j in range(1, width):
            total = load(turned, j)
            for k in range(j):
                total = minus_product(total, panel[low + j, low + k], load(turned, k))
            store(turned, j, total)
        for i in range(first, last):
            for k in range(width):
                panel[i, low + k] = turned[k, i - first] / pivots[low + k]


@njit(cache=True, nogil=True, fastmath={"contract"})
def subtract_products(lower: Floats, pivots: Floats, target: Floats) -> None:
    """Subtract L D L^T from the first columns of `target`, in its lower triangle."""
    height, width = lower.shape
    columns = target.shape[1]
    if height * columns * width < SMALL_UPDATE:
        for i in range(height):
            for k in range(width):
                entry = lower[i, k] * pivots[k]
                for j in range(min(columns, i + 1)):
                    target[i, j] -= entry * lower[j, k]
        return
    left, scaled = np.empty((height, width)), np.empty((columns, width))
    for i in range(height):
        for k in range(width):
            left[i, k] = lower[i, k]
    for j in range(columns):
        for k in range(width):
            scaled[j, k] = lower[j, k] * pivots[k]
    for start in range(0, height, ROWS_AT_ONCE):
        end = min(height, start + ROWS_AT_ONCE)
        reach = min(columns, end)
        products = np.dot(left[start:end], scaled[:reach].T)
        for i in range(start, end):
            for j in range(reach):
                target[i, j] -= products[i - start, j]


@njit(cache=True, nogil=True)
def subtract_square(lower: Floats, pivots: Floats, target: Floats) -> None:
    """Subtract L D L^T from the lower triangle of `target`, whose rows are padded to a multiple of eight entries."""
    height, width = lower.shape
    packed = np.zeros((target.shape[1] // LANES * width, LANES))
    for i in range(height):
        first, lane = i // LANES * width, i % LANES
        for k in range(width):
            packed[first + k, lane] = lower[i, k] * pivots[k]
    fours = height - height % 4
    for i in range(0, fours, 4):
        for part in range((i + 3) // LANES + 1):
            column, first = part * LANES, part * width
            a, b = load_part(target, i, column), load_part(target, i + 1, column)
            c, d = load_part(target, i + 2, column), load_part(target, i + 3, column)
            for k in range(width):
                others = load(packed, first + k)
                a = minus_product(a, lower[i, k], others)
                b = minus_product(b, lower[i + 1, k], others)
                c = minus_product(c, lower[i + 2, k], others)
                d = minus_product(d, lower[i + 3, k], others)
            store_part(target, i, column, a)
            store_part(target, i + 1, column, b)
            store_part(target, i + 2, column, c)
            store_part(target, i + 3, column, d)
    for i in range(fours, height):
        for part in range(i // LANES + 1):
            a = load_part(target, i, part * LANES)
            for k in range(width):
                a = minus_product(a, lower[i, k], load(packed, part * width + k))
            store_part(target, i, part * LANES, a)
