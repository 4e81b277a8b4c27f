"""What the tasks accept as a map of a surface, brought to one form."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from surfexp.contract.arrays import Floats
from surfexp.io.hemisphere import check_same_side
from surfexp.io.map_files import name_of_map, read_scalars, side_by_side
from surfexp.mesh.both_hemispheres import of_both
from surfexp.mesh.given_arrays import real_array
from surfexp.mesh.surface import HEMISPHERES, Surface
from surfexp.mesh.vertex_colours import colour_of
from surfexp.tasks.both_files import maps_of_both, require_same_columns
from surfexp.tasks.given_surface import sides_of
from surfexp.tasks.maps_of_file import vertices_of_file

MapLike = str | Path | ArrayLike | Mapping[str, ArrayLike]


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
    require_same_columns(left, right, "map")
    return np.asarray(of_both(surface, left, right), dtype=np.float64)


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
