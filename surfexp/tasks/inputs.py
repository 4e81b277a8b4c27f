"""What the tasks accept as a surface and as a map, brought to one form."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from surfexp.contract.arrays import Floats
from surfexp.mesh.surface import Surface
from surfexp.mesh.surface_part import SurfacePart, finite_mask, surface_part
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.validate import require_valid

SurfaceLike = Any
MapLike = str | ArrayLike


def as_surface(given: SurfaceLike) -> Surface:
    """Return a `Surface` made of what is given.

    Parameters
    ----------
    given : Surface, TriangleMesh, (vertices, faces), an object with `vertices` and `faces`, or a path
        Trimesh's, Open3D's, LaPy's (`v`, `t`) and nilearn's (`coordinates`, `faces`) meshes have such attributes.

    Raises
    ------
    ValueError
        If it is none of these, or the mesh has a defect that a method cannot work with.
    """
    if isinstance(given, Surface):
        return given
    if isinstance(given, str | Path):
        from surfexp.tasks.files import read

        return read(given)
    if isinstance(given, TriangleMesh):
        mesh = given
    else:
        vertices, faces = _arrays_of(given)
        mesh = TriangleMesh(np.asarray(vertices, dtype=np.float64), np.asarray(faces))
    require_valid(mesh, "surface")
    return Surface(mesh)


def _arrays_of(given: SurfaceLike) -> tuple[ArrayLike, ArrayLike]:
    for names in (("vertices", "faces"), ("coordinates", "faces"), ("v", "t"), ("vertices", "triangles")):
        if all(hasattr(given, name) for name in names):
            vertices, faces = (getattr(given, name) for name in names)
            return vertices, faces
    if isinstance(given, tuple | list) and len(given) == 2:
        return given[0], given[1]
    raise ValueError(
        f"surface is a {type(given).__name__}: give a Surface, a path, (vertices, faces) or an object that has both"
    )


def name_of(values: MapLike) -> str:
    """Return the name by which a map was given; "map" where it was given as numbers."""
    return values if isinstance(values, str) else "map"


def as_map(surface: Surface, given: MapLike) -> Floats:
    """Return (n,) or (n, c) float64 values of a map: an array, or the name of one that the surface carries.

    Raises
    ------
    ValueError
        If the surface has no such map, or the array is not real or of another length.
    """
    if isinstance(given, str):
        if given not in surface.scalars:
            known = ", ".join(surface.scalars) or "none"
            raise ValueError(f"surface {surface.name!r} has no map {given!r}; it has {known}")
        return surface.scalars[given]
    array = np.asarray(given)
    if array.dtype.kind not in "buif":
        raise ValueError(f"map is an array of {array.dtype}, real numbers are needed")
    if array.shape[:1] != (len(surface.mesh.vertices),) or array.ndim > 2:
        raise ValueError(f"map has shape {array.shape}, the surface has {len(surface.mesh.vertices)} vertices")
    return array.astype(np.float64)


def part_for(surface: Surface, *maps: Floats) -> SurfacePart:
    """Return the part of a surface on which a task runs: its mask, and without one where every map is finite.

    Raises
    ------
    ValueError
        If a map is unknown somewhere inside the mask.
    """
    finite = finite_mask(maps, len(surface.mesh.vertices))
    mask = surface.mask if surface.mask is not None else finite
    part = surface_part(surface.mesh, mask)
    if surface.mask is not None and finite is not None:
        unknown = int((~finite[part.vertices]).sum())
        if unknown:
            raise ValueError(
                f"map is NaN at {unknown} of the {len(part.vertices)} vertices inside the mask: narrow the mask"
            )
    return part


def mask_notes(surface: Surface, part: SurfacePart) -> tuple[str, ...]:
    """Say which part was taken where nobody asked for one, and what the mask cut off."""
    if part.is_whole:
        return ()
    if surface.mask is not None:
        return part.notes
    taken = f"The map is finite at {len(part.vertices)} of {part.whole_count} vertices: these are the mask."
    return (taken, *part.notes)
