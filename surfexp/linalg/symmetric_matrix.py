"""Symmetric matrices as a person hands them in: checked, as sparse rows, and held against a pattern."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array, issparse, sparray, spmatrix

from surfexp.linalg.ldlt_symbolic import both_triangles

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
    rows = csr_array(given, dtype=np.float64)
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


def entries_outside(matrix: csr_array, pattern: csr_array) -> int:
    """How many entries that are not 0 lie outside of the pattern."""
    if np.array_equal(matrix.indptr, pattern.indptr) and np.array_equal(matrix.indices, pattern.indices):
        return 0
    ones = both_triangles(pattern)
    other = csr_array((np.asarray(matrix.data != 0.0, dtype=float), matrix.indices, matrix.indptr), shape=matrix.shape)
    return int(other.sum() - other.multiply(ones > 0).sum())
