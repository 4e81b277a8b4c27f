"""The numeric phase of a sparse LDL^T: multifrontal elimination with dense fronts, without pivoting."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.mesh.triangle_mesh import Floats, Integers

COLUMNS_AT_ONCE = 32
ROWS_AT_ONCE = 96
SMALL_UPDATE = 600


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
        Panels of L, row by row; the diagonal of the diagonal blocks is not used.
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
    stack, top, replaced = np.empty(1 << 16), 0, 0
    for s in range(count):
        start, end = columns[s], columns[s + 1]
        below = rows[row_starts[s] : row_starts[s + 1]]
        width, height = end - start, end - start + len(below)
        panel = factor[panels[s] : panels[s + 1]].reshape(height, width)
        for a in range(width):
            place[start + a] = a
        for a in range(len(below)):
            place[below[a]] = width + a
        gather(indptr, indices, entries, start, end, place, panel)
        update = np.zeros((len(below), len(below)))
        child, bottom = first_child[s], top
        while child != -1:
            child_rows = rows[row_starts[child] : row_starts[child + 1]]
            size = len(child_rows)
            bottom = min(bottom, begins[child])
            child_update = stack[begins[child] : begins[child] + size * size].reshape(size, size)
            extend(child_update, child_rows, place, panel, update)
            child = sibling[child]
        top = bottom
        replaced += eliminate_front(panel, pivots[start:end], smallest, update)
        if len(below):
            stack = with_room(stack, top, update.size)
            begins[s] = top
            stack[top : top + update.size] = update.ravel()
            top += update.size
            sibling[s] = first_child[parents[s]]
            first_child[parents[s]] = s
    return replaced


@njit(cache=True, nogil=True)
def gather(
    indptr: Integers, indices: Integers, entries: Floats, start: int, end: int, place: Integers, panel: Floats
) -> None:
    """Write the columns start..end-1 of the matrix, from the diagonal down, into the panel."""
    panel[:] = 0.0
    for j in range(start, end):
        for p in range(indptr[j], indptr[j + 1]):
            if indices[p] >= j:
                panel[place[indices[p]], j - start] = entries[p]


@njit(cache=True, nogil=True)
def with_room(stack: Floats, used: int, needed: int) -> Floats:
    """Return the stack, or a longer copy, so that `needed` entries fit behind the `used` ones."""
    if used + needed <= len(stack):
        return stack
    longer = np.empty(max(2 * len(stack), used + needed))
    longer[:used] = stack[:used]
    return longer


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


@njit(cache=True, nogil=True, fastmath={"contract"}, error_model="numpy")
def eliminate_front(panel: Floats, pivots: Floats, smallest: float, update: Floats) -> int:
    """Factorise the columns of a front in place and subtract their products from the rest of it."""
    height, width = panel.shape
    replaced = 0
    for low in range(0, width, COLUMNS_AT_ONCE):
        high = min(width, low + COLUMNS_AT_ONCE)
        transposed, bad = eliminate_block(panel, low, high, pivots, smallest)
        replaced += bad
        for i in range(high, height):
            for k in range(low, high):
                entry = panel[i, k]
                for j in range(k + 1, high):
                    panel[i, j] -= entry * transposed[k - low, j - low]
                panel[i, k] = entry / pivots[k]
        if high < width:
            subtract_products(panel[high:, low:high], pivots[low:high], panel[high:, high:])
    if height > width:
        subtract_products(panel[width:], pivots, update)
    return replaced


@njit(cache=True, nogil=True, fastmath={"contract"}, error_model="numpy")
def eliminate_block(panel: Floats, low: int, high: int, pivots: Floats, smallest: float) -> tuple[Floats, int]:
    """Factorise a diagonal block; returns the transpose of its L and how many pivots were replaced."""
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
    return transposed, replaced


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
    left = np.ascontiguousarray(lower)
    scaled = left[:columns] * pivots
    for start in range(0, height, ROWS_AT_ONCE):
        end = min(height, start + ROWS_AT_ONCE)
        reach = min(columns, end)
        target[start:end, :reach] -= np.dot(left[start:end], scaled[:reach].T)
