"""Where the entries of the element matrices of a triangulation go in compressed rows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from surfexp.mesh.triangle_mesh import Integers

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
    """Append each column, in ascending order, to the rows of the vertices around it: rows come out sorted."""
    starts, around = _faces_around(faces, vertex_count)
    seen, indptr = np.full(vertex_count, -1, np.int32), np.zeros(vertex_count + 1, np.int32)
    for column in range(vertex_count):
        count = 0
        for at in range(starts[column], starts[column + 1]):
            for a in range(3):
                row = faces[around[at] >> 2, a]
                count += seen[row] != column
                seen[row] = column
        indptr[column + 1] = indptr[column] + count
    indices, ends, place = np.empty(indptr[-1], np.int32), indptr[:-1].copy(), np.empty(vertex_count, np.int32)
    slots, diagonal = np.empty((len(faces), 3, 3), np.int32), np.full(vertex_count, -1, np.int32)
    seen[:] = -1
    for column in range(vertex_count):
        for at in range(starts[column], starts[column + 1]):
            face, b = around[at] >> 2, around[at] & 3
            for a in range(3):
                row = faces[face, a]
                if seen[row] != column:
                    seen[row] = column
                    place[row] = ends[row]
                    indices[ends[row]] = column
                    ends[row] += 1
                slots[face, a, b] = place[row]
            diagonal[column] = place[column]
    return indptr, indices, slots, diagonal


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
