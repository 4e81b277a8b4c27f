"""Stiffness and mass matrices, written straight into compressed rows."""

from __future__ import annotations

import numpy as np
from numba import njit
from scipy.sparse import csr_array

from surfexp.contract.arrays import Floats, Integers
from surfexp.operators.assembly_pattern import AssemblyPattern, Indices, assembly_pattern
from surfexp.operators.surface_operator import SurfaceOperator


def stiffness(operator: SurfaceOperator) -> csr_array:
    """Return Q of (2.37), Q_ij = int grad e_i . grad e_j: the cotangent matrix, positive semidefinite."""
    if operator.matrices is not None:
        return operator.matrices[0]
    pattern = operator.pattern
    return _matrix(pattern, _stiffness(operator.hat_gradients, operator.areas, pattern.slots, len(pattern.indices)))


def mass_matrix(operator: SurfaceOperator) -> csr_array:
    """Return K of (2.37), K_ij = int e_i e_j: the consistent mass matrix; `SurfaceOperator.mass` is the lumped one."""
    if operator.matrices is not None:
        return operator.matrices[1]
    pattern = operator.pattern
    return _matrix(pattern, _mass(operator.areas, pattern.slots, len(pattern.indices)))


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
    pattern = assembly_pattern(faces, vertex_count)
    return _matrix(pattern, scatter(np.ascontiguousarray(local), pattern.slots, len(pattern.indices)))


@njit(cache=True, nogil=True)
def scatter(local: Floats, slots: Indices, count: int) -> Floats:
    """Return the entries of a matrix from its element matrices (m, 3, 3) and the `slots` and size of a pattern."""
    entries = np.zeros(count)
    for f in range(len(slots)):
        for a in range(3):
            for b in range(3):
                entries[slots[f, a, b]] += local[f, a, b]
    return entries


def _matrix(pattern: AssemblyPattern, entries: Floats) -> csr_array:
    size = len(pattern.indptr) - 1
    matrix = csr_array((entries, pattern.indices.copy(), pattern.indptr.copy()), shape=(size, size))
    matrix.has_canonical_format = True
    return matrix


@njit(cache=True, nogil=True)
def _stiffness(hats: Floats, areas: Floats, slots: Indices, count: int) -> Floats:
    entries = np.zeros(count)
    for f in range(len(slots)):
        for a in range(3):
            x, y = areas[f] * hats[f, a, 0], areas[f] * hats[f, a, 1]
            for b in range(3):
                entries[slots[f, a, b]] += x * hats[f, b, 0] + y * hats[f, b, 1]
    return entries


@njit(cache=True, nogil=True)
def _mass(areas: Floats, slots: Indices, count: int) -> Floats:
    entries = np.zeros(count)
    for f in range(len(slots)):
        share = areas[f] / 12.0
        for a in range(3):
            for b in range(3):
                entries[slots[f, a, b]] += share
            entries[slots[f, a, a]] += share
    return entries
