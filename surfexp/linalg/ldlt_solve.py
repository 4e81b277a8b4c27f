"""Triangular solves with supernodal panels, eight right-hand sides at once."""

from __future__ import annotations

from numba import njit

from surfexp.contract.arrays import Floats, Integers
from surfexp.linalg.lanes import LANES, load, minus_product, quotient, store
from surfexp.linalg.ldlt_front import padded


@njit(cache=True, nogil=True)
def solve_lanes(
    columns: Integers, row_starts: Integers, rows: Integers, panels: Integers, factor: Floats, pivots: Floats, x: Floats
) -> None:
    """Overwrite the (n, 8) right-hand sides `x`, in elimination order, by the solutions of L D L^T x = b.

    Parameters
    ----------
    columns, row_starts, rows, panels
        As in `SymbolicFactor`.
    factor, pivots
        As `ldlt_numeric.eliminate` writes them.
    """
    for s in range(len(columns) - 1):
        below = rows[row_starts[s] : row_starts[s + 1]]
        forward(factor[panels[s] : panels[s + 1]], columns[s], columns[s + 1] - columns[s], below, x)
    for s in range(len(columns) - 2, -1, -1):
        below = rows[row_starts[s] : row_starts[s + 1]]
        for i in range(columns[s], columns[s + 1]):
            store(x, i, quotient(load(x, i), pivots[i]))
        backward(factor[panels[s] : panels[s + 1]], columns[s], columns[s + 1] - columns[s], below, x)


@njit(cache=True, nogil=True)
def forward(panel: Floats, start: int, width: int, below: Integers, x: Floats) -> None:
    """Solve with the unit lower triangle of one supernode and pass the products down to its rows, four at a time."""
    for i in range(1, width):
        row = load(x, start + i)
        for j in range(i):
            row = minus_product(row, panel[i * width + j], load(x, start + j))
        store(x, start + i, row)
    at = padded(width * width)
    for first in range(0, len(below), LANES):
        last = min(first + LANES, len(below))
        fours = first + (last - first) // 4 * 4
        for t in range(first, fours, 4):
            a, b, c, d = load(x, below[t]), load(x, below[t + 1]), load(x, below[t + 2]), load(x, below[t + 3])
            entry = at + t - first
            for j in range(width):
                solved = load(x, start + j)
                a = minus_product(a, panel[entry], solved)
                b = minus_product(b, panel[entry + 1], solved)
                c = minus_product(c, panel[entry + 2], solved)
                d = minus_product(d, panel[entry + 3], solved)
                entry += LANES
            store(x, below[t], a)
            store(x, below[t + 1], b)
            store(x, below[t + 2], c)
            store(x, below[t + 3], d)
        for t in range(fours, last):
            a = load(x, below[t])
            for j in range(width):
                a = minus_product(a, panel[at + j * LANES + t - first], load(x, start + j))
            store(x, below[t], a)
        at += width * LANES


@njit(cache=True, nogil=True)
def backward(panel: Floats, start: int, width: int, below: Integers, x: Floats) -> None:
    """Gather the solutions below one supernode, four columns at a time, and solve with the transposed triangle."""
    fours = width - width % 4
    for j in range(0, fours, 4):
        a, b, c, d = load(x, start + j), load(x, start + j + 1), load(x, start + j + 2), load(x, start + j + 3)
        at = padded(width * width) + j * LANES
        for first in range(0, len(below), LANES):
            for t in range(first, min(first + LANES, len(below))):
                solved, entry = load(x, below[t]), at + t - first
                a = minus_product(a, panel[entry], solved)
                b = minus_product(b, panel[entry + LANES], solved)
                c = minus_product(c, panel[entry + 2 * LANES], solved)
                d = minus_product(d, panel[entry + 3 * LANES], solved)
            at += width * LANES
        store(x, start + j, a)
        store(x, start + j + 1, b)
        store(x, start + j + 2, c)
        store(x, start + j + 3, d)
    for j in range(fours, width):
        a = load(x, start + j)
        at = padded(width * width) + j * LANES
        for first in range(0, len(below), LANES):
            for t in range(first, min(first + LANES, len(below))):
                a = minus_product(a, panel[at + t - first], load(x, below[t]))
            at += width * LANES
        store(x, start + j, a)
    for j in range(width - 2, -1, -1):
        a = load(x, start + j)
        for i in range(j + 1, width):
            a = minus_product(a, panel[i * width + j], load(x, start + i))
        store(x, start + j, a)
