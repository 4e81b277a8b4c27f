"""What the tasks accept as a surface, brought to one form."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from surfexp.contract.arrays import Floats, Integers
from surfexp.io.map_shapes import scalar_channels
from surfexp.mesh.both_hemispheres import joined
from surfexp.mesh.given_arrays import index_array, real_array
from surfexp.mesh.surface import HEMISPHERES, Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.tasks.soundness import sound_part

SurfaceLike = Any
# of trimesh, nilearn, LaPy and Open3D
ATTRIBUTES = (("vertices", "faces"), ("coordinates", "faces"), ("v", "t"), ("vertices", "triangles"))


def as_surface(given: SurfaceLike) -> Surface:
    """Return a `Surface` made of what is given.

    Parameters
    ----------
    given : Surface, TriangleMesh, (vertices, faces), an object with `vertices` and `faces`, or a path
        Trimesh's, Open3D's, LaPy's (`v`, `t`) and nilearn's (`coordinates`, `faces`) meshes have such attributes. A mapping
        of "left" and "right" to any of these, nilearn's PolyMesh and its SurfaceImage, with its map, are both hemispheres.

    Raises
    ------
    ValueError
        If it is none of these, or the mesh has a defect that a method cannot work with.
    """
    if isinstance(given, Surface):
        return sound_part(given, given.name)
    if isinstance(given, str | Path):
        from surfexp.tasks.files import read

        return read(given)
    if (parts := sides_of(given, "mesh")) is not None:
        return _of_sides(parts, sides_of(given, "data"))
    mesh = given if isinstance(given, TriangleMesh) else TriangleMesh(*arrays_of(given))
    return sound_part(Surface(mesh), "surface")


def sides_of(given: Any, what: str) -> Mapping[str, Any] | None:
    """Return what a mapping, or nilearn's PolyMesh, PolyData or SurfaceImage, has for each hemisphere, or None.

    Parameters
    ----------
    given : object
    what : {"mesh", "data"}
        Of an image.
    """
    held = getattr(given, what, None)
    parts = given if isinstance(given, Mapping) else getattr(held if hasattr(held, "parts") else given, "parts", None)
    return parts if isinstance(parts, Mapping) and parts and set(parts) <= set(HEMISPHERES) else None


def _of_sides(parts: Mapping[str, Any], values: Mapping[str, Any] | None) -> Surface:
    """Return the surface of one or both hemispheres; the map of an image is called "map"."""
    surfaces = {}
    for side, part in parts.items():
        one = as_surface(part)
        if values is not None and values is not parts:
            one = replace(one, scalars=scalar_channels({"map": real_array(values[side], "map")}))
        surfaces[side] = replace(one, hemisphere=one.hemisphere or side)
    if len(surfaces) == 1:
        return next(iter(surfaces.values()))
    return sound_part(joined(surfaces["left"], surfaces["right"]), "surface")


def is_mesh(given: Any) -> bool:
    """Whether something is a surface, a mesh of any library, or vertices with faces, rather than a map or a result.

    Parameters
    ----------
    given : object
        Two arrays are a mesh where both have two axes.
    """
    if isinstance(given, tuple | list):
        return len(given) == 2 and all(np.ndim(part) == 2 for part in given)
    return isinstance(given, Surface) or any(all(hasattr(given, name) for name in names) for names in ATTRIBUTES)


def arrays_of(given: SurfaceLike) -> tuple[Floats, Integers]:
    """Return vertices and faces of what is given, as numbers of the right type; defects are left as they are.

    Raises
    ------
    ValueError
        If it is nothing that `as_surface` takes, or an array does not hold real or whole numbers.
    """
    vertices, faces = _pair(given)
    return real_array(vertices, "vertices", infinite=True), index_array(faces, "faces")


def _pair(given: SurfaceLike) -> tuple[ArrayLike, ArrayLike]:
    if isinstance(given, Surface):
        return given.mesh.vertices, given.mesh.faces
    for names in ATTRIBUTES:
        if all(hasattr(given, name) for name in names):
            vertices, faces = (getattr(given, name) for name in names)
            return vertices, faces
    if isinstance(given, tuple | list) and len(given) == 2:
        return given[0], given[1]
    raise ValueError(
        f"surface is a {type(given).__name__}: give a Surface, a path, (vertices, faces) or an object that has both"
    )
