"""Triangular solves with supernodal panels, eight right-hand sides at once."""

from __future__ import annotations

from numba import njit

from surfexp.contract.arrays import Floats, Integers
from surfexp.linalg.lanes import load, minus_product, quotient, store


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
    at = width * width
    fours = len(below) - len(below) % 4
    for t in range(0, fours, 4):
        a, b, c, d = load(x, below[t]), load(x, below[t + 1]), load(x, below[t + 2]), load(x, below[t + 3])
        for j in range(width):
            solved = load(x, start + j)
            a = minus_product(a, panel[at + j], solved)
            b = minus_product(b, panel[at + width + j], solved)
            c = minus_product(c, panel[at + 2 * width + j], solved)
            d = minus_product(d, panel[at + 3 * width + j], solved)
        store(x, below[t], a)
        store(x, below[t + 1], b)
        store(x, below[t + 2], c)
        store(x, below[t + 3], d)
        at += 4 * width
    for t in range(fours, len(below)):
        a = load(x, below[t])
        for j in range(width):
            a = minus_product(a, panel[at + j], load(x, start + j))
        store(x, below[t], a)
        at += width


@njit(cache=True, nogil=True)
def backward(panel: Floats, start: int, width: int, below: Integers, x: Floats) -> None:
    """Gather the solutions below one supernode, four columns at a time, and solve with the transposed triangle."""
    fours = width - width % 4
    for j in range(0, fours, 4):
        a, b, c, d = load(x, start + j), load(x, start + j + 1), load(x, start + j + 2), load(x, start + j + 3)
        at = width * width + j
        for t in range(len(below)):
            solved = load(x, below[t])
            a = minus_product(a, panel[at], solved)
            b = minus_product(b, panel[at + 1], solved)
            c = minus_product(c, panel[at + 2], solved)
            d = minus_product(d, panel[at + 3], solved)
            at += width
        store(x, start + j, a)
        store(x, start + j + 1, b)
        store(x, start + j + 2, c)
        store(x, start + j + 3, d)
    for j in range(fours, width):
        a = load(x, start + j)
        at = width * width + j
        for t in range(len(below)):
            a = minus_product(a, panel[at], load(x, below[t]))
            at += width
        store(x, start + j, a)
    for j in range(width - 2, -1, -1):
        a = load(x, start + j)
        for i in range(j + 1, width):
            a = minus_product(a, panel[i * width + j], load(x, start + i))
        store(x, start + j, a)
