"""Where the entries of the element matrices of a triangulation go in compressed rows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from surfexp.contract.arrays import Integers

Indices = NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class AssemblyPattern:
    """Compressed rows of all pairs of vertices that share a face.

    Parameters
    ----------
    indptr : (n + 1,) int32
    indices : (nnz,) int32
        Sorted in each row.
    slots : (m, 3, 3) int32
        The entry to which each entry of an element matrix is added.
    diagonal : (n,) int32
        The entries of the diagonal.
    """

    indptr: Indices
    indices: Indices
    slots: Indices
    diagonal: Indices


def assembly_pattern(faces: Integers, vertex_count: int) -> AssemblyPattern:
    """Return the pattern of a triangulation.

    Parameters
    ----------
    faces : (m, 3) int64
    vertex_count : int
        A vertex without faces has an empty row, and -1 in `diagonal`.
    """
    return AssemblyPattern(*_pattern(faces, vertex_count))


@njit(cache=True, nogil=True)
def _pattern(faces: Integers, vertex_count: int) -> tuple[Indices, Indices, Indices, Indices]:
    """Fill rows as long as on a closed manifold, where a vertex has as many neighbours as faces; else count them first."""
    starts, around = _faces_around(faces, vertex_count)
    indptr = starts.copy()
    rows = 0
    for vertex in range(vertex_count):
        rows += starts[vertex + 1] > starts[vertex]
        indptr[vertex + 1] += rows
    slots, diagonal = np.empty((len(faces), 3, 3), np.int32), np.full(vertex_count, -1, np.int32)
    indices = np.empty(indptr[-1], np.int32)
    if not _fill(faces, starts, around, indptr, indices, slots, diagonal):
        indptr = _count(faces, starts, around)
        indices = np.empty(indptr[-1], np.int32)
        _fill(faces, starts, around, indptr, indices, slots, diagonal)
    return indptr, indices, slots, diagonal


@njit(cache=True, nogil=True)
def _count(faces: Integers, starts: Indices, around: Indices) -> Indices:
    """Return where the rows begin."""
    seen, indptr = np.full(len(starts) - 1, -1, np.int32), np.zeros(len(starts), np.int32)
    for column in range(len(starts) - 1):
        count = 0
        for at in range(starts[column], starts[column + 1]):
            for a in range(3):
                row = faces[around[at] >> 2, a]
                count += seen[row] != column
                seen[row] = column
        indptr[column + 1] = indptr[column] + count
    return indptr


@njit(cache=True, nogil=True)
def _fill(
    faces: Integers,
    starts: Indices,
    around: Indices,
    indptr: Indices,
    indices: Indices,
    slots: Indices,
    diagonal: Indices,
) -> bool:
    """Append each column, in ascending order, to the rows of the vertices around it; False if a row is too short or long."""
    vertex_count = len(starts) - 1
    # column written last, its place, next place, end: side by side, as vertices come in no order
    rows = np.full((vertex_count, 4), -1, np.int32)
    for vertex in range(vertex_count):
        rows[vertex, 2], rows[vertex, 3] = indptr[vertex], indptr[vertex + 1]
    for column in range(vertex_count):
        for at in range(starts[column], starts[column + 1]):
            face, b = around[at] >> 2, around[at] & 3
            for a in range(3):
                row = rows[faces[face, a]]
                if row[0] != column:
                    if row[2] == row[3]:
                        return False
                    row[0], row[1] = column, row[2]
                    indices[row[2]] = column
                    row[2] += 1
                slots[face, a, b] = row[1]
        if starts[column + 1] > starts[column]:
            diagonal[column] = rows[column, 1]
    filled = True
    for vertex in range(vertex_count):
        filled &= rows[vertex, 2] == rows[vertex, 3]
    return filled


@njit(cache=True, nogil=True)
def _faces_around(faces: Integers, vertex_count: int) -> tuple[Indices, Indices]:
    """Return compressed lists of 4 face + corner at each vertex."""
    starts = np.zeros(vertex_count + 1, np.int32)
    for f in range(len(faces)):
        for a in range(3):
            starts[faces[f, a] + 1] += 1
    for vertex in range(vertex_count):
        starts[vertex + 1] += starts[vertex]
    around, ends = np.empty(3 * len(faces), np.int32), starts.copy()
    for f in range(len(faces)):
        for a in range(3):
            around[ends[faces[f, a]]] = 4 * f + a
            ends[faces[f, a]] += 1
    return starts, around
