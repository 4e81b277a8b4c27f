"""Triangular solves with supernodal panels, eight right-hand sides at once."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.mesh.triangle_mesh import Floats, Integers

LANES = 8
LARGE_PANEL = 512


@njit(cache=True, nogil=True, fastmath={"contract"})
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
        start, width = columns[s], columns[s + 1] - columns[s]
        below = rows[row_starts[s] : row_starts[s + 1]]
        forward(factor[panels[s] : panels[s + 1]].reshape(width + len(below), width), start, below, x)
    for i in range(len(pivots)):
        for c in range(LANES):
            x[i, c] /= pivots[i]
    for s in range(len(columns) - 2, -1, -1):
        start, width = columns[s], columns[s + 1] - columns[s]
        below = rows[row_starts[s] : row_starts[s + 1]]
        backward(factor[panels[s] : panels[s + 1]].reshape(width + len(below), width), start, below, x)


@njit(cache=True, nogil=True, fastmath={"contract"})
def forward(panel: Floats, start: int, below: Integers, x: Floats) -> None:
    """Solve with the unit lower triangle of one supernode and pass the products down to its rows."""
    width = panel.shape[1]
    for i in range(1, width):
        subtract_row(panel[i], i, start, x, start + i)
    if width >= LANES and width * len(below) >= LARGE_PANEL:
        products = np.dot(panel[width:], x[start : start + width])
        for t in range(len(below)):
            for c in range(LANES):
                x[below[t], c] -= products[t, c]
    else:
        for t in range(len(below)):
            subtract_row(panel[width + t], width, start, x, below[t])


@njit(cache=True, nogil=True, fastmath={"contract"}, inline="always")
def subtract_row(coefficients: Floats, count: int, start: int, x: Floats, row: int) -> None:
    """x[row] -= sum_j coefficients[j] x[start + j], four terms at a time so that x[row] is loaded less often."""
    fours = count - count % 4
    for j in range(0, fours, 4):
        a, b, d, e = coefficients[j], coefficients[j + 1], coefficients[j + 2], coefficients[j + 3]
        g = start + j
        for c in range(LANES):
            x[row, c] -= a * x[g, c] + b * x[g + 1, c] + d * x[g + 2, c] + e * x[g + 3, c]
    for j in range(fours, count):
        a = coefficients[j]
        for c in range(LANES):
            x[row, c] -= a * x[start + j, c]


@njit(cache=True, nogil=True, fastmath={"contract"})
def backward(panel: Floats, start: int, below: Integers, x: Floats) -> None:
    """Gather the solutions below one supernode and solve with the transpose of its unit lower triangle."""
    width, count = panel.shape[1], len(below)
    if width >= LANES and width * count >= LARGE_PANEL:
        gathered = np.empty((count, LANES))
        for t in range(count):
            for c in range(LANES):
                gathered[t, c] = x[below[t], c]
        products = np.dot(panel[width:].T, gathered)
        for j in range(width):
            for c in range(LANES):
                x[start + j, c] -= products[j, c]
    else:
        fours = count - count % 4
        for t in range(0, fours, 4):
            q, r, u, v = below[t], below[t + 1], below[t + 2], below[t + 3]
            for j in range(width):
                at, k = start + j, width + t
                a, b, d, e = panel[k, j], panel[k + 1, j], panel[k + 2, j], panel[k + 3, j]
                for c in range(LANES):
                    x[at, c] -= a * x[q, c] + b * x[r, c] + d * x[u, c] + e * x[v, c]
        for t in range(fours, count):
            for j in range(width):
                for c in range(LANES):
                    x[start + j, c] -= panel[width + t, j] * x[below[t], c]
    for i in range(width - 1, 0, -1):
        for j in range(i):
            for c in range(LANES):
                x[start + j, c] -= panel[i, j] * x[start + i, c]
