"""Gauss-Seidel sweeps on a sparse linear system."""

from __future__ import annotations

from numba import njit
from scipy.sparse import csr_array

from surfexp.contract.arrays import Floats, Integers


def gauss_seidel(matrix: csr_array, right_hand_side: Floats, start: Floats, sweeps: int) -> Floats:
    """Return `start` after forward Gauss-Seidel sweeps on A x = b.

    Parameters
    ----------
    matrix : (n, n) csr_array
        With a diagonal that is nowhere zero.
    right_hand_side, start : (n,) float64
    sweeps : int
    """
    solution = start.copy()
    _sweep(matrix.indptr, matrix.indices, matrix.data, right_hand_side, solution, sweeps)
    return solution


@njit(cache=True, nogil=True)
def _sweep(
    indptr: Integers, indices: Integers, data: Floats, right_hand_side: Floats, solution: Floats, sweeps: int
) -> None:
    for _ in range(sweeps):
        for row in range(len(solution)):
            total = right_hand_side[row]
            diagonal = 1.0
            for at in range(indptr[row], indptr[row + 1]):
                if indices[at] == row:
                    diagonal = data[at]
                else:
                    total -= data[at] * solution[indices[at]]
            solution[row] = total / diagonal
