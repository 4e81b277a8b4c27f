"""The vertices of a file beside those of its repaired mesh."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.equal_rows import first_equal_row
from surfexp.mesh.repair import Repaired
from surfexp.mesh.triangle_mesh import TriangleMesh


@dataclass(frozen=True, eq=False)
class FileVertices:
    """Which vertices of a file a repaired mesh has: all, under their own numbers, and copies of some behind them.

    Parameters
    ----------
    origin : (p,) int64
        The vertex of the file that each vertex of the mesh is: its own number, or that of which it is a copy.
    standing : (n,) int64
        The vertex of the mesh that stands for each vertex of the file: its own number, or the one it was merged into.
    """

    origin: Integers
    standing: Integers

    def onto_mesh(self, values: NDArray[np.generic]) -> NDArray[np.generic]:
        """Return rows of the file's vertices as rows of the mesh's.

        Parameters
        ----------
        values : (n, ...) array

        Returns
        -------
        (p, ...) array
        """
        return values[self.origin]

    def onto_file(self, values: NDArray[np.generic]) -> NDArray[np.generic]:
        """Return rows of the mesh's vertices as rows of the file's.

        Parameters
        ----------
        values : (p, ...) array

        Returns
        -------
        (n, ...) array
            Where a vertex has no face any more, as the mesh has it.
        """
        return values[self.standing]

    def of(self, inside: NDArray[np.bool_]) -> FileVertices:
        """Return those of some components of the mesh, as a file of their own.

        Parameters
        ----------
        inside : (p,) bool
            Which vertices of the mesh are kept.

        Returns
        -------
        FileVertices
        """
        owned = inside[self.standing]
        return FileVertices((np.cumsum(owned) - 1)[self.origin[inside]], (np.cumsum(inside) - 1)[self.standing[owned]])

    def then(self, later: FileVertices) -> FileVertices:
        """Return the vertices of the file beside those of the mesh after one more repair.

        Parameters
        ----------
        later : FileVertices
            Of the mesh as its file.

        Returns
        -------
        FileVertices
        """
        return FileVertices(self.origin[later.origin], later.standing[self.standing])


def under_own_numbers(vertices: Floats, faces: Integers, repaired: Repaired) -> tuple[TriangleMesh, FileVertices]:
    """Return a repaired mesh on the vertices of the file it was read from.

    Vertices that have no face any more stay where they are. Where repair has split a vertex, the first part keeps the number.

    Parameters
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int64
        Before the repair.
    repaired : Repaired

    Returns
    -------
    TriangleMesh
        n vertices, and behind them the copies.
    FileVertices
    """
    count, origin = len(vertices), repaired.origin
    _, first = np.unique(origin, return_index=True)
    later = np.setdiff1d(np.arange(len(origin)), first)
    number = np.empty(len(origin), dtype=np.int64)
    number[first], number[later] = origin[first], count + np.arange(len(later))
    points = np.concatenate([vertices, repaired.mesh.vertices[later]])
    points[origin[first]] = repaired.mesh.vertices[first]
    whole = np.arange(count)
    used, named = np.zeros(count, dtype=bool), np.zeros(count, dtype=bool)
    used[origin], named[faces] = True, True
    same, kept = first_equal_row(vertices), np.full(count, -1, dtype=np.int64)
    # the last that is written counts
    kept[same[used][::-1]] = whole[used][::-1]
    merged = named & ~used & (kept[same] >= 0) & np.isfinite(vertices).all(axis=1)
    standing = np.where(merged, kept[same], whole)
    return TriangleMesh(points, number[repaired.mesh.faces]), FileVertices(
        np.concatenate([whole, origin[later]]), standing
    )
