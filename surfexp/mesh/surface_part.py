"""Part of a surface under a mask: the cut mesh, and maps restricted to it and put back on the whole."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.given_arrays import mask_array
from surfexp.mesh.triangle_mesh import TriangleMesh

Mask = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class SurfacePart:
    """The faces whose three vertices lie in a mask, as a mesh of its own with a boundary.

    A method that runs on `mesh` meets natural (Neumann) conditions where the mask ends, and cannot see what lies outside.

    Parameters
    ----------
    mesh : TriangleMesh
        p vertices, in the order of the whole.
    vertices : (p,) int64
        The vertex of the whole from which each one comes.
    whole_count : int
        Number of vertices of the whole.
    notes : tuple of str
        What the mask cut off, one sentence each.
    length : float
        Of the whole, that is 1 on `mesh`: a power of two, and 1 unless its coordinates are of extraordinary size.
    """

    mesh: TriangleMesh
    vertices: Integers
    whole_count: int
    notes: tuple[str, ...] = ()
    length: float = 1.0

    @cached_property
    def is_whole(self) -> bool:
        """Whether nothing was cut away."""
        return len(self.vertices) == self.whole_count

    def restrict(self, values: ArrayLike) -> NDArray[np.generic]:
        """Return the rows that belong to the part.

        Parameters
        ----------
        values : (n, ...) array

        Returns
        -------
        (p, ...) array

        Raises
        ------
        ValueError
            If there is not one row for each vertex of the whole.
        """
        return _rows(values, self.whole_count, "map", "the surface")[self.vertices]

    def extend(self, values: ArrayLike) -> Floats:
        """Put values of the part back on the whole.

        Parameters
        ----------
        values : (p, ...) array

        Returns
        -------
        (n, ...) float64
            NaN outside of the part.

        Raises
        ------
        ValueError
            If there is not one row for each vertex of the part.
        """
        array = _rows(values, len(self.vertices), "result", "the part").astype(np.float64, copy=False)
        whole = np.full((self.whole_count, *array.shape[1:]), np.nan, order="F" if array.ndim == 2 else "C")
        whole[self.vertices] = array
        return whole


def _rows(values: ArrayLike, count: int, name: str, owner: str) -> NDArray[np.generic]:
    """Return values as an array that has one row for each vertex."""
    array = np.asarray(values)
    if array.shape[:1] != (count,):
        raise ValueError(f"{name} has shape {array.shape}, {owner} has {count} vertices")
    return array


def surface_part(mesh: TriangleMesh, mask: ArrayLike | None) -> SurfacePart:
    """Cut a mesh along a mask; None, or a mask that is true everywhere, returns the mesh itself.

    Parameters
    ----------
    mesh : TriangleMesh
    mask : (n,) bool, or numbers of which 0 and NaN are outside, optional

    Returns
    -------
    SurfacePart
        Its notes name vertices of the mask that belong to no whole face, and components that the mask separates.

    Raises
    ------
    ValueError
        If the mask has another length, or contains no whole face.
    """
    count = len(mesh.vertices)
    if mask is None:
        return SurfacePart(mesh, np.arange(count), count)
    inside = mask_array(mask, count)
    if inside.all():
        return SurfacePart(mesh, np.arange(count), count)
    faces = mesh.faces[inside[mesh.faces].all(axis=1)]
    if not len(faces):
        raise ValueError(f"mask holds {inside.sum()} of {count} vertices and no whole face: widen it")
    vertices = np.unique(faces)
    number = np.full(count, -1, dtype=np.int64)
    number[vertices] = np.arange(len(vertices))
    part = TriangleMesh(mesh.vertices[vertices], number[faces])
    return SurfacePart(part, vertices, count, tuple(_notes(mesh, part, int(inside.sum()))))


def finite_mask(maps: Sequence[Floats], count: int) -> Mask | None:
    """Return where every map is finite, or None where all are finite everywhere.

    Raises
    ------
    ValueError
        If a value is infinite: NaN says that nothing was measured, infinity says nothing.
    """
    inside = np.ones(count, dtype=bool)
    for values in maps:
        infinite = int(np.isinf(values).sum())
        if infinite:
            raise ValueError(f"map has {infinite} infinite values of {np.size(values)}: mark what is unknown by NaN")
        inside &= np.isfinite(np.reshape(values, (count, -1))).all(axis=1)
    return None if inside.all() else inside


def _notes(whole: TriangleMesh, part: TriangleMesh, masked: int) -> list[str]:
    notes = []
    lost = masked - len(part.vertices)
    if lost:
        notes.append(f"{lost} of {masked} vertices of the mask belong to no face inside it and are left out.")
    pieces = part.component_count
    if pieces > whole.component_count:
        sizes = np.sort(np.bincount(part.component_labels))[::-1]
        shown = ", ".join(map(str, sizes[:5])) + (", ..." if len(sizes) > 5 else "")
        notes.append(f"The mask separates the surface into {pieces} components of {shown} vertices.")
    return notes
