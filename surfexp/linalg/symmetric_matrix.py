"""Symmetric matrices as a person hands them in: checked, as sparse rows, and held against an analysis."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import ArrayLike
from scipy.sparse import csr_array, issparse, sparray, spmatrix

from surfexp.contract.arrays import Integers
from surfexp.linalg.ldlt_symbolic import SymbolicFactor, permuted

# largest |A - A^T| over the largest |A| that is taken for rounding
SYMMETRY = 1e-12


def symmetric_rows(matrix: ArrayLike | sparray | spmatrix) -> csr_array:
    """The matrix as float64 rows, refused unless it is real, square and symmetric."""
    given: Any = matrix if issparse(matrix) else np.asarray(matrix)
    if np.iscomplexobj(given):
        raise ValueError(
            "matrix is complex, a real symmetric one is needed: factorise [[Re, -Im], [Im, Re]] in its place"
        )
    if given.ndim != 2 or given.shape[0] != given.shape[1] or not given.shape[0]:
        shape = " x ".join(map(str, given.shape)) or "()"
        raise ValueError(f"matrix has shape {shape}, a factorisation needs a square one of at least 1 x 1")
    # without a copy the indices are the caller's, and sorting them moves the caller's entries
    rows = csr_array(given, dtype=np.float64, copy=True)
    rows.sum_duplicates()
    if not np.isfinite(rows.data).all():
        raise ValueError(f"matrix has {int((~np.isfinite(rows.data)).sum())} entries that are not finite")
    difference = abs(rows - rows.T)
    largest, bound = difference.max() if difference.nnz else 0.0, SYMMETRY * abs(rows.data).max(initial=0.0)
    if largest > bound:
        raise ValueError(
            f"matrix is not symmetric, |A - A^T| is up to {largest:.1e}, at most {bound:.1e} is taken for rounding: "
            "give both triangles, or (A + A.T) / 2"
        )
    return rows


def in_elimination_order(matrix: csr_array, symbolic: SymbolicFactor) -> csr_array:
    """P A P^T without stored zeros, refused where it has entries for which the factor has no place."""
    if matrix.shape[0] != symbolic.size:
        raise ValueError(f"matrix has {matrix.shape[0]} rows, the analysis is of one with {symbolic.size}")
    ordered = permuted(matrix, symbolic.permutation)
    ordered.eliminate_zeros()
    outside = entries_outside(ordered.indptr, ordered.indices, symbolic.columns, symbolic.row_starts, symbolic.rows)
    if outside:
        raise ValueError(
            f"matrix has {outside} entries where the factorised one has none: factorise it anew, with ldlt(matrix)"
        )
    return ordered


@njit(cache=True, nogil=True)
def entries_outside(
    indptr: Integers, indices: Integers, columns: Integers, row_starts: Integers, rows: Integers
) -> int:
    """How many stored entries of a symmetric matrix in elimination order the panels of a factor have no row for."""
    mark, outside = np.full(len(indptr) - 1, -1, np.int64), 0
    for s in range(len(columns) - 1):
        for p in range(row_starts[s], row_starts[s + 1]):
            mark[rows[p]] = s
        for p in range(indptr[columns[s]], indptr[columns[s + 1]]):
            if indices[p] >= columns[s + 1] and mark[indices[p]] != s:
                outside += 2
    return outside
