"""What the tasks accept as a surface and as a map, brought to one form."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from surfexp.contract.arrays import Floats, Integers
from surfexp.io.hemisphere import check_same_side
from surfexp.io.map_files import name_of_map, read_scalars, side_by_side
from surfexp.io.map_shapes import scalar_channels
from surfexp.mesh.both_hemispheres import joined, of_both
from surfexp.mesh.given_arrays import index_array, real_array
from surfexp.mesh.length_scale import scaled
from surfexp.mesh.surface import HEMISPHERES, Surface
from surfexp.mesh.surface_part import SurfacePart, finite_mask, surface_part
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.vertex_colours import colour_of
from surfexp.tasks.both_files import maps_of_both
from surfexp.tasks.maps_of_file import vertices_of_file
from surfexp.tasks.soundness import sound_part, usable_vertices

SurfaceLike = Any
MapLike = str | Path | ArrayLike | Mapping[str, ArrayLike]
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


def name_of(values: MapLike) -> str:
    """Return the name by which a map was given, of a file its own; "map" where it was given as numbers."""
    if isinstance(values, Path) or (isinstance(values, str) and Path(values).is_file()):
        return name_of_map(values)
    return values if isinstance(values, str) else "map"


def as_map(surface: Surface, given: MapLike) -> Floats:
    """Return (n,) or (n, c) float64 values of a map: an array, the name of one that the surface carries, or a file.

    The name "color" stands for red, green and blue.

    Raises
    ------
    ValueError
        If the surface has no such map, or the array is not real or of another length; if the file cannot be read or is of
        the other hemisphere.
    """
    if _is_of_files(given, surface):
        given = _of_files(surface, given)
    if isinstance(given, str):
        colour = colour_of(surface.scalars, given)
        if colour is not None:
            return colour
        if given not in surface.scalars:
            known = ", ".join(surface.scalars) or "none"
            raise ValueError(
                f"surface {surface.name!r} has no map {given!r}; it has {known}; give a name, a file or numbers"
            )
        return surface.scalars[given]
    array = _map_of_sides(surface, given)
    if surface.file is not None and array.shape[:1] == surface.file.standing.shape:
        array = np.asarray(surface.file.onto_mesh(array), dtype=np.float64)
    if array.shape[:1] != (len(surface.mesh.vertices),) or array.ndim > 2:
        raise ValueError(f"map has shape {array.shape}, the surface has {len(surface.mesh.vertices)} vertices")
    return array.copy() if array is given else array


def _is_of_files(given: MapLike, surface: Surface) -> bool:
    """Whether a map is given by its file, or by one for each hemisphere."""
    if isinstance(given, Mapping):
        return surface.right is not None and all(isinstance(file, str | Path) for file in given.values())
    return isinstance(given, Path) or (
        isinstance(given, str) and given not in surface.scalars and Path(given).is_file()
    )


def _of_files(surface: Surface, given: Any) -> Floats:
    if surface.right is not None:
        return side_by_side(maps_of_both(surface, given), "map")
    check_same_side("map", given, surface.hemisphere)
    return read_scalars(given, surface.hemisphere, vertices_of_file(surface))


def _map_of_sides(surface: Surface, given: Any) -> Floats:
    """Return an array, or the parts of a map of both hemispheres as one array."""
    parts = sides_of(given, "data")
    if parts is None:
        if isinstance(given, Mapping):
            keys = ", ".join(map(str, given)) or "none"
            raise ValueError(f"map has the parts {keys}: give it as left and right, or give an array")
        return real_array(given, "map")
    if surface.right is None:
        if surface.hemisphere not in parts:
            raise ValueError(f"map has {' and '.join(parts)}, the surface is of hemisphere {surface.hemisphere!r}")
        return real_array(parts[surface.hemisphere], "map")
    missing = [side for side in HEMISPHERES if side not in parts]
    if missing:
        raise ValueError(f"map has no {missing[0]} hemisphere, the surface is both: give both")
    left, right = (real_array(parts[side], f"map, {side}") for side in HEMISPHERES)
    return np.asarray(of_both(surface, left, right), dtype=np.float64)


def as_labels(surface: Surface, keys: Integers) -> Integers:
    """Return (n,) labels on the vertices of a surface; those of a file that was repaired are carried over.

    Raises
    ------
    ValueError
        If there are fewer or more.
    """
    if surface.file is not None and len(keys) == len(surface.file.standing):
        keys = np.asarray(surface.file.onto_mesh(keys))
    if len(keys) != len(surface.mesh.vertices):
        raise ValueError(f"labels have shape {np.shape(keys)}, the surface has {len(surface.mesh.vertices)} vertices")
    return np.asarray(keys, dtype=np.int64)


def as_single_map(surface: Surface, given: MapLike) -> Floats:
    """Return (n,) float64 values of a map of one channel, as `as_map` does.

    Raises
    ------
    ValueError
        If it has several.
    """
    values = as_map(surface, given)
    if values.ndim == 2 and values.shape[1] != 1:
        raise ValueError(f"the map has {values.shape[1]} channels, one is needed: give one column")
    return values.reshape(-1)


def require_connected(part: SurfacePart, what: str, both: bool = False) -> None:
    """Refuse a part of several pieces, naming the smallest.

    Parameters
    ----------
    part : SurfacePart
    what : str
        What needs one piece, in the plural.
    both : bool
        Whether the surface is both hemispheres, so that each of them is what to take.

    Raises
    ------
    ValueError
        If it has several.
    """
    labels = part.mesh.component_labels
    sizes = np.bincount(labels)
    if len(sizes) > 1:
        smallest = int(np.argmin(sizes))
        first = int(part.vertices[np.argmax(labels == smallest)])
        if both:
            raise ValueError(
                f"the surface is both hemispheres, {what} need one: give the file of one side, or "
                "surface.hemispheres()['left']"
            )
        raise ValueError(
            f"the surface has {len(sizes)} pieces inside its mask, {what} need one: the smallest has {sizes[smallest]} "
            f"vertices, vertex {first} among them; take the largest: a mask of it, or surfexp repair FILE --largest-component"
        )


def part_for(surface: Surface, *maps: Floats) -> SurfacePart:
    """Return the part of a surface on which a task runs: where every map is finite, inside the mask if there is one.

    Vertices that belong to no face, or have no finite position, are outside. Notes say which part was taken. Its mesh has
    coordinates of ordinary size: a length on it times `length` is one of the surface.

    Raises
    ------
    ValueError
        If a map is known nowhere, or nowhere inside the mask.
    """
    count = len(surface.mesh.vertices)
    finite, usable = finite_mask(maps, count), usable_vertices(surface.mesh)
    if finite is not None and not finite.any():
        raise ValueError(f"map is NaN at all of {count} vertices: give numbers where it is known")
    inside = usable if surface.mask is None else usable & surface.mask
    if finite is not None and inside.any() and not (finite & inside).any():
        raise ValueError(f"map is NaN at all {inside.sum()} vertices inside the mask: give another mask")
    part = surface_part(surface.mesh, inside if finite is None else inside & finite)
    mesh, length = scaled(part.mesh)
    return replace(part, mesh=mesh, length=length, notes=(*_taken(surface, part, finite, usable), *part.notes))


def _taken(
    surface: Surface, part: SurfacePart, finite: NDArray[np.bool_] | None, usable: NDArray[np.bool_]
) -> Iterator[str]:
    """Say which part is taken where nobody asked for one."""
    if lost := int((~usable).sum()):
        yield f"{lost} of {part.whole_count} vertices belong to no face or have no finite position: they are outside."
    if surface.mask is None and finite is not None:
        yield f"The map is finite at {len(part.vertices)} of {part.whole_count} vertices: these are the mask."
    if surface.mask is not None and finite is not None:
        inside = usable & surface.mask
        if unknown := int((inside & ~finite).sum()):
            yield f"The map is NaN at {unknown} of the {inside.sum()} vertices inside the mask: they are outside."
