"""Stiffness and mass matrices, written straight into compressed rows."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.sparse import csr_array

from surfexp.mesh.triangle_mesh import Floats, Integers
from surfexp.operators.surface_operator import SurfaceOperator


def stiffness(operator: SurfaceOperator) -> csr_array:
    """Return Q of (2.37), Q_ij = int grad e_i . grad e_j: the cotangent matrix, positive semidefinite."""
    hats = operator.hat_gradients
    local = np.einsum("f,fia,fja->fij", operator.areas, hats, hats)
    return assemble(operator.faces, local, operator.vertex_count)


def mass_matrix(operator: SurfaceOperator) -> csr_array:
    """Return K of (2.37), K_ij = int e_i e_j: the consistent mass matrix; `SurfaceOperator.mass` is the lumped one."""
    local = operator.areas[:, None, None] / 12.0 * (np.ones((3, 3)) + np.eye(3))
    return assemble(operator.faces, local, operator.vertex_count)


def assemble(faces: Integers, local: Floats, vertex_count: int) -> csr_array:
    """Sum element matrices into a global one.

    Parameters
    ----------
    faces : (m, 3) int64
    local : (m, 3, 3) float64
        Element matrices.
    vertex_count : int

    Returns
    -------
    (n, n) csr_array
        With sorted column indices.
    """
    degrees = np.bincount(faces.ravel(), minlength=vertex_count)
    rows = np.concatenate([[0], np.cumsum(3 * degrees)])
    indptr, indices, data = _assemble(faces, np.ascontiguousarray(local), rows)
    matrix = csr_array((data, indices, indptr), shape=(vertex_count, vertex_count))
    matrix.sort_indices()
    return matrix


@njit(cache=True, nogil=True)
def _assemble(faces: Integers, local: Floats, rows: Integers) -> tuple[NDArray[np.int32], NDArray[np.int32], Floats]:
    """Append each entry to its row, or add it where the column is there already; then close the gaps."""
    columns = np.empty(rows[-1], np.int32)
    entries = np.empty(rows[-1])
    ends = rows[:-1].copy()
    for f in range(len(faces)):
        for a in range(3):
            row = faces[f, a]
            for b in range(3):
                at = rows[row]
                while at < ends[row] and columns[at] != faces[f, b]:
                    at += 1
                if at == ends[row]:
                    columns[at], entries[at] = faces[f, b], 0.0
                    ends[row] += 1
                entries[at] += local[f, a, b]
    indptr = np.zeros(len(rows), np.int32)
    count = 0
    for row in range(len(ends)):
        for at in range(rows[row], ends[row]):
            columns[count], entries[count] = columns[at], entries[at]
            count += 1
        indptr[row + 1] = count
    return indptr, columns[:count].copy(), entries[:count].copy()
