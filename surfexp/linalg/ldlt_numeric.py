"""The numeric phase of a sparse LDL^T: multifrontal elimination with dense fronts, without pivoting."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats, Integers
from surfexp.linalg.lanes import LANES
from surfexp.linalg.ldlt_front import eliminate_front, padded


@njit(cache=True, nogil=True, fastmath={"contract"}, error_model="numpy")
def eliminate(
    indptr: Integers,
    indices: Integers,
    entries: Floats,
    columns: Integers,
    row_starts: Integers,
    rows: Integers,
    parents: Integers,
    panels: Integers,
    smallest: float,
    factor: Floats,
    pivots: Floats,
) -> int:
    """Fill `factor` and `pivots` with L and D of a permuted matrix (Duff and Reid 1983).

    Each supernode gathers its columns and the updates of its children in a dense front, eliminates its own columns, and
    leaves what remains as an update for its parent on a stack.

    Parameters
    ----------
    indptr, indices, entries
        Compressed rows of the whole symmetric matrix, in elimination order.
    columns, row_starts, rows, parents, panels
        As in `SymbolicFactor`.
    smallest : float
        A pivot of less modulus is replaced by this, with its sign.
    factor : float64 array
        Panels of L, as `SymbolicFactor` describes; the diagonal of the diagonal blocks is not used.
    pivots : (n,) float64
        The diagonal of D.

    Returns
    -------
    int
        How many pivots were replaced.
    """
    count = len(columns) - 1
    place = np.full(len(pivots), -1, np.int64)
    first_child, sibling = np.full(count, -1, np.int64), np.full(count, -1, np.int64)
    begins = np.zeros(count, np.int64)
    front = np.empty(largest_front(columns, row_starts))
    stack, top, replaced = np.empty(1 << 16), 0, 0
    for s in range(count):
        start, end = columns[s], columns[s + 1]
        below = rows[row_starts[s] : row_starts[s + 1]]
        width, height = end - start, end - start + len(below)
        panel = front[: height * width].reshape(height, width)
        for a in range(width):
            place[start + a] = a
        for a in range(len(below)):
            place[below[a]] = width + a
        gather(indptr, indices, entries, start, end, place, panel)
        update = np.zeros((len(below), padded(len(below))))
        child, bottom = first_child[s], top
        while child != -1:
            child_rows = rows[row_starts[child] : row_starts[child + 1]]
            size, row = len(child_rows), padded(len(child_rows))
            bottom = min(bottom, begins[child])
            child_update = stack[begins[child] : begins[child] + size * row].reshape(size, row)
            extend(child_update, child_rows, place, panel, update)
            child = sibling[child]
        top = bottom
        replaced += eliminate_front(panel, pivots[start:end], smallest, update)
        keep(panel, factor[panels[s] : panels[s + 1]])
        if len(below):
            stack = with_room(stack, top, update.size)
            begins[s] = top
            top = push(stack, top, update)
            sibling[s] = first_child[parents[s]]
            first_child[parents[s]] = s
    return replaced


@njit(cache=True, nogil=True)
def gather(
    indptr: Integers, indices: Integers, entries: Floats, start: int, end: int, place: Integers, panel: Floats
) -> None:
    """Write the columns start..end-1 of the matrix, from the diagonal down, into the panel."""
    for i in range(len(panel)):
        for j in range(panel.shape[1]):
            panel[i, j] = 0.0
    for j in range(start, end):
        for p in range(indptr[j], indptr[j + 1]):
            if indices[p] >= j:
                panel[place[indices[p]], j - start] = entries[p]


@njit(cache=True, nogil=True)
def largest_front(columns: Integers, row_starts: Integers) -> int:
    """Return how many entries the columns of the largest front have."""
    most = 0
    for s in range(len(columns) - 1):
        width = columns[s + 1] - columns[s]
        most = max(most, width * (width + row_starts[s + 1] - row_starts[s]))
    return most


@njit(cache=True, nogil=True)
def keep(panel: Floats, kept: Floats) -> None:
    """Copy the eliminated columns of a front in the order in which solves read them."""
    height, width = panel.shape
    for i in range(width):
        for j in range(width):
            kept[i * width + j] = panel[i, j]
    first = padded(width * width)
    for i in range(width, height, LANES):
        for j in range(width):
            for lane in range(LANES):
                kept[first + lane] = panel[i + lane, j] if i + lane < height else 0.0
            first += LANES


@njit(cache=True, nogil=True)
def with_room(stack: Floats, used: int, needed: int) -> Floats:
    """Return the stack, or a longer copy, so that `needed` entries fit behind the `used` ones."""
    if used + needed <= len(stack):
        return stack
    longer = np.empty(max(2 * len(stack), used + needed))
    for i in range(used):
        longer[i] = stack[i]
    return longer


@njit(cache=True, nogil=True)
def push(stack: Floats, top: int, update: Floats) -> int:
    """Copy an update behind the `top` entries of the stack; return how many there are then."""
    for i in range(len(update)):
        for j in range(update.shape[1]):
            stack[top + j] = update[i, j]
        top += update.shape[1]
    return top


@njit(cache=True, nogil=True)
def extend(child: Floats, child_rows: Integers, place: Integers, panel: Floats, update: Floats) -> None:
    """Add a child's update (its lower triangle) to the front of its parent."""
    width = panel.shape[1]
    split = 0
    while split < len(child_rows) and place[child_rows[split]] < width:
        split += 1
    for i in range(len(child_rows)):
        row = place[child_rows[i]]
        for j in range(min(split, i + 1)):
            panel[row, place[child_rows[j]]] += child[i, j]
        for j in range(split, i + 1):
            update[row - width, place[child_rows[j]] - width] += child[i, j]
