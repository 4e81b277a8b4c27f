"""Maps, labels and masks as a command is given them: files, LEFT+RIGHT of both hemispheres, or names that a surface carries."""

from __future__ import annotations

from collections.abc import Mapping
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING, Any

from surfexp.commands.certificate import Inputs

if TYPE_CHECKING:
    from surfexp.contract.arrays import Floats
    from surfexp.mesh.label_map import LabelMap
    from surfexp.mesh.surface import Surface


def both_of(given: str) -> str | dict[str, str]:
    """Return LEFT+RIGHT as a pair of hemispheres, anything else as it is: the name of one file may have a + too."""
    cuts = [k for k, letter in enumerate(given) if letter == "+"]
    if not cuts or Path(given).is_file():
        return given
    halves = [(given[:k], given[k + 1 :]) for k in cuts]
    left, right = next((pair for pair in halves if all(Path(file_of(half)).is_file() for half in pair)), halves[0])
    return {"left": left, "right": right}


def add_files(files: Inputs, given: str | dict[str, str]) -> None:
    """Add a file, or those of a pair, to the inputs."""
    for one in [given] if isinstance(given, str) else given.values():
        files.add(file_of(one))


def file_of(given: str) -> str:
    """The file of a mask, which may name labels behind a colon."""
    return given if Path(given).is_file() else given.partition(":")[0]


def map_of(surface: Surface, given: str, files: Inputs, side: str | None) -> Floats:
    """Return a map by the name that the surface carries it under, or those of a file side by side."""
    from surfexp.io.map_files import side_by_side

    return side_by_side(given_maps(surface, given, files, side), given)


def shown_map(surface: Surface, given: str | None, files: Inputs, side: str | None) -> Any:
    """Return what a picture shows: labels as `shown_labels`, maps by name where they have their own, a map, or nothing."""
    from surfexp.io.map_files import side_by_side
    from surfexp.tasks.maps_of_file import MapsOfFile, have_own_names

    if not given:
        return None
    labels = shown_labels(surface, given, files, side)
    if labels is not None:
        return labels
    found = given_maps(surface, given, files, side)
    return MapsOfFile(found) if have_own_names(found) else side_by_side(found, given)


def shown_labels(surface: Surface, given: str, files: Inputs, side: str | None) -> LabelMap | None:
    """Return labels by the name that the surface carries them under, or those of a file of labels, which joins the inputs.

    Raises
    ------
    ValueError
        If the file cannot be read, or is of the other hemisphere.
    """
    from surfexp.io.hemisphere import check_same_side
    from surfexp.io.label_colours import read_coloured_labels
    from surfexp.io.map_files import LABEL_FILES
    from surfexp.tasks.maps_of_file import vertices_of_file

    if given in surface.labels:
        return surface.labels[given]
    if given in surface.scalars or not given.lower().endswith(LABEL_FILES):
        return None
    if surface.right is not None:
        from surfexp.tasks.both_files import labels_of_both

        add_files(files, pair := both_of(given))
        return labels_of_both(surface, pair)
    files.add(given)
    if side is None:
        check_same_side("labels", given, surface.hemisphere)
    return read_coloured_labels(given, surface.hemisphere, vertices_of_file(surface))


def shown_borders(surface: Surface, given: str | None, files: Inputs, side: str | None) -> LabelMap | str | None:
    """Return labels as `shown_labels`; what is neither a name nor a file of labels is left to the picture, which says so."""
    return given and (shown_labels(surface, given, files, side) or given)


def label_of_bar(values: Any, map_name: str | None) -> str:
    """What the colour bar of a file's map is called: by its name without folder and format, or by that of each map in it."""
    from surfexp.io.hemisphere import common_name
    from surfexp.io.quantity_of_file import quantity_named

    if isinstance(values, Mapping) or not map_name:
        return ""
    pair = both_of(map_name)
    name = Path(pair).name if isinstance(pair, str) else common_name(*(Path(one).name for one in pair.values()))
    return quantity_named(name)


def given_maps(surface: Surface, given: str, files: Inputs, side: str | None) -> dict[str, Floats]:
    """Return a map by the name that the surface carries it under, or those of a file, which joins the inputs.

    Parameters
    ----------
    side : {"left", "right"}, optional
        As the user says; it overrides what the file says.

    Raises
    ------
    ValueError
        If there is neither, the file cannot be read, or it is of the other hemisphere.
    """
    from surfexp.io.hemisphere import check_same_side, holds_both
    from surfexp.io.map_files import read_maps
    from surfexp.mesh.vertex_colours import colour_of
    from surfexp.tasks.maps_of_file import vertices_of_file

    if given in surface.scalars:
        return {given: surface.scalars[given]}
    if surface.right is not None and (holds_both(Path(given)) or "+" in given):
        from surfexp.tasks.both_files import maps_of_both

        add_files(files, pair := both_of(given))
        return maps_of_both(surface, pair)
    colour = None if Path(given).exists() else colour_of(surface.scalars, given)
    if colour is not None:
        return {given: colour}
    if surface.scalars and not Path(given).exists():
        known = sorted(surface.scalars)
        near = get_close_matches(given, known, 1)
        hint = f"did you mean {near[0]!r}?" if near else f"it carries {', '.join(known)}"
        raise ValueError(f"{given} is no file, and no map that {surface.name} carries; {hint}")
    if surface.right is not None:
        raise ValueError(f"{given} is one file, the surface is both hemispheres: write LEFT+RIGHT")
    files.add(given)
    if side is None:
        check_same_side("map", given, surface.hemisphere)
    return read_maps(given, surface.hemisphere, vertices_of_file(surface))
