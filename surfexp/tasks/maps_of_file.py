"""The maps of one file, by the names that it gives them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from surfexp.contract.arrays import Floats
from surfexp.io.hemisphere import check_same_side
from surfexp.io.map_files import LABEL_FILES, read_maps
from surfexp.mesh.surface import HEMISPHERES, Surface
from surfexp.tasks.both_files import maps_of_both


class MapsOfFile(dict[str, Floats]):
    """Maps of one file, or of one for each hemisphere, by the names that it gives them."""


def maps_of_file(surface: Surface, given: Any) -> MapsOfFile:
    """Return the maps of a file, or of one for each hemisphere, by name; none of anything else, and of labels.

    Raises
    ------
    ValueError
        If a file cannot be read, or is of the other hemisphere.
    """
    files = list(given.values()) if is_pair(given) and surface.right is not None else [given]
    if not all(_is_file(surface, file) for file in files):
        return MapsOfFile()
    if surface.right is not None:
        return MapsOfFile(maps_of_both(surface, given))
    check_same_side("map", given, surface.hemisphere)
    return MapsOfFile(read_maps(given, surface.hemisphere, vertices_of_file(surface)))


def vertices_of_file(surface: Surface) -> int:
    """Return how many vertices the file of a surface has."""
    return len(surface.mesh.vertices) if surface.file is None else len(surface.file.standing)


def is_pair(given: Any) -> bool:
    """Whether something is given for the left and for the right hemisphere."""
    return isinstance(given, Mapping) and set(given) == set(HEMISPHERES)


def have_own_names(names: Iterable[str]) -> bool:
    """Whether names of maps are those of different things, not of a series, which differ by numbers alone.

    Examples
    --------
    >>> have_own_names(["t", "p_t"]), have_own_names(["frame 1", "frame 2"]), have_own_names(["thickness"])
    (True, False, False)
    """
    return len({re.sub(r"\d+", "", name) for name in names}) > 1


def _is_file(surface: Surface, given: Any) -> bool:
    if not isinstance(given, str | Path) or str(given).lower().endswith(LABEL_FILES):
        return False
    return isinstance(given, Path) or (given not in surface.scalars and Path(given).is_file())
