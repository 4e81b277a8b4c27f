"""Triangular solves with supernodal panels for one right-hand side."""

from __future__ import annotations

from numba import njit

from surfexp.contract.arrays import Floats, Integers


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
    for s in range(len(columns) - 1):
        start, width = columns[s], columns[s + 1] - columns[s]
        at = panels[s]
        for i in range(width):
            total = 0.0
            for j in range(i):
                total += factor[at + j] * x[start + j]
            x[start + i] -= total
            at += width
        for t in range(row_starts[s], row_starts[s + 1]):
            total = 0.0
            for j in range(width):
                total += factor[at + j] * x[start + j]
            x[rows[t]] -= total
            at += width
    for i in range(len(pivots)):
        x[i] /= pivots[i]
    for s in range(len(columns) - 2, -1, -1):
        start, width = columns[s], columns[s + 1] - columns[s]
        at = panels[s] + width * width
        for t in range(row_starts[s], row_starts[s + 1]):
            value = x[rows[t]]
            for j in range(width):
                x[start + j] -= factor[at + j] * value
            at += width
        for i in range(width - 1, 0, -1):
            at = panels[s] + i * width
            value = x[start + i]
            for j in range(i):
                x[start + j] -= factor[at + j] * value
