"""Products of tall blocks of eight columns, row by row: what block Lanczos does between two solves."""

from __future__ import annotations

import numpy as np
from numba import njit
from scipy.sparse import csr_array

from surfexp.mesh.triangle_mesh import Floats, Integers

LANES = 8


def multiply_lanes(matrix: csr_array, block: Floats) -> Floats:
    """Return A X for an (n, 8) C-ordered X, faster than the general product of scipy."""
    result = np.empty((matrix.shape[0], LANES))
    _multiply(matrix.indptr, matrix.indices, matrix.data, block, result)
    return result


@njit(cache=True, nogil=True, fastmath={"contract"})
def _multiply(indptr: Integers, indices: Integers, entries: Floats, block: Floats, result: Floats) -> None:
    total = np.empty(LANES)
    for i in range(len(result)):
        total[:] = 0.0
        for p in range(indptr[i], indptr[i + 1]):
            entry, row = entries[p], indices[p]
            for c in range(LANES):
                total[c] += entry * block[row, c]
        for c in range(LANES):
            result[i, c] = total[c]


@njit(cache=True, nogil=True, fastmath={"contract"})
def subtract_two(new: Floats, before: Floats, first: Floats, here: Floats, second: Floats) -> None:
    """Subtract before @ first + here @ second from `new` in place; all of them (n, 8), the factors (8, 8)."""
    total = np.empty(LANES)
    for i in range(len(new)):
        for c in range(LANES):
            total[c] = new[i, c]
        for k in range(LANES):
            a, b = before[i, k], here[i, k]
            for c in range(LANES):
                total[c] -= a * first[k, c] + b * second[k, c]
        for c in range(LANES):
            new[i, c] = total[c]
