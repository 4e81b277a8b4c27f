"""Both hemispheres from files: a pair {"left": file, "right": file}, or one file that holds both."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.io.hemisphere import check_given_side, common_name, holds_both, without_side
from surfexp.io.label_colours import read_coloured_labels
from surfexp.io.map_files import mask_notes, name_of_map, read_maps, read_mask
from surfexp.io.map_shapes import scalar_channels
from surfexp.io.npz import says_sides
from surfexp.mesh.both_hemispheres import joined, joined_labels, of_both
from surfexp.mesh.coloured_labels import coloured_as
from surfexp.mesh.given_arrays import mask_array
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.surface import HEMISPHERES, Surface
from surfexp.tasks.surface_file import PathLike, read_surface

# a mapping with "left" and "right", or the path of a file that holds both
Pair = Any


def read_both(
    left: PathLike | None, right: PathLike | None, maps: Any, labels: Any, mask: Any, unit: str, repair: bool
) -> Surface:
    """Read two hemispheres as one surface; arguments as those of `surfexp.read`.

    Raises
    ------
    ValueError
        As `surfexp.read`, or if a file is of the other hemisphere.
    """
    if left is None or right is None:
        raise ValueError(f"{'left' if left is None else 'right'} is missing: give both left= and right=, or one path")
    files = {"left": left, "right": right}
    map_pairs, label_pairs = _by_name(maps, "maps"), _by_name(labels, "labels")
    parts = {}
    for side in HEMISPHERES:
        own_maps = {name: of_side(pair, side, f"map {name!r}") for name, pair in map_pairs.items()}
        own_labels = {name: of_side(pair, side, f"labels {name!r}") for name, pair in label_pairs.items()}
        own_mask = None if mask is None else of_side(mask, side, "mask")
        check_given_side("surface", files[side], side)
        if isinstance(own_mask, str | Path):
            check_given_side("mask", own_mask if Path(own_mask).is_file() else str(own_mask).partition(":")[0], side)
        parts[side] = read_surface(
            files[side], maps=own_maps, labels=own_labels, mask=own_mask, unit=unit, hemisphere=side, repair=repair
        )
    names = [Path(files[side]).name for side in HEMISPHERES]
    both = joined(parts["left"], parts["right"], name_of_map(common_name(*names)) or "both hemispheres")
    tables = {
        name: coloured_as(table, *(parts[side].labels[name] for side in HEMISPHERES))
        for name, table in both.labels.items()
    }
    return replace(both, labels=tables)


def with_files_of_both(surface: Surface, maps: Any, labels: Any, mask: Any) -> Surface:
    """Return a surface that is both hemispheres with what stands in other files; arguments as those of `surfexp.read`.

    Raises
    ------
    ValueError
        As `surfexp.read`.
    """
    scalars, tables = dict(surface.scalars), dict(surface.labels)
    for name, pair in _by_name(maps, "maps").items():
        found = maps_of_both(surface, pair)
        alone = len(found) == 1
        scalars |= scalar_channels({name if alone else f"{name} {key}": values for key, values in found.items()})
    for name, pair in _by_name(labels, "labels").items():
        tables[name] = labels_of_both(surface, pair)
    changed = replace(surface, scalars=scalars, labels=tables)
    if mask is None:
        return changed
    if not isinstance(mask, str | Path | Mapping):
        return replace(changed, mask=mask_array(mask, len(surface.mesh.vertices)))
    files = {side: of_side(mask, side, "mask") for side in HEMISPHERES}
    counts = {side: len(part.mesh.vertices) for side, part in surface.hemispheres().items()}
    left, right = (read_mask(file, counts[side], side) for side, file in files.items())
    inside = of_both(surface, left, right, "mask")
    said = dict.fromkeys(note for side, file in files.items() for note in mask_notes(file, side))
    return replace(changed, mask=inside.astype(bool), notes=(*surface.notes, *said))


def of_side(given: Pair, side: str, what: str) -> Any:
    """Return what a pair has for a hemisphere; one file that holds both serves either.

    Raises
    ------
    ValueError
        If it is no pair and no such file, or the file says the other hemisphere.
    """
    if isinstance(given, Mapping) and set(given) == set(HEMISPHERES):
        found = given[side]
    elif isinstance(given, str | Path) and holds_both(Path(given)):
        found = given
        if Path(given).suffix.lower() == ".npz" and Path(given).is_file() and not says_sides(Path(given)):
            raise ValueError(
                f"{what} {given} does not say which rows are left and right: give {{'left': file, 'right': file}}, or an "
                f"array 'hemisphere' of 'left' and 'right' in it"
            )
    else:
        raise ValueError(
            f"{what} is {given!r} for two hemispheres: give {{'left': file, 'right': file}}, or a file that holds both "
            "(.dscalar.nii, .npz)"
        )
    if isinstance(found, str | Path) and what != "mask":
        check_given_side(what, found, side)
    return found


def maps_of_both(surface: Surface, given: Pair) -> dict[str, Floats]:
    """Return the maps of a pair on a surface that is both hemispheres, by the name that both files give them.

    Raises
    ------
    ValueError
        If a file cannot be read, is of the other hemisphere, or the two do not fit.
    """
    counts = {side: len(part.mesh.vertices) for side, part in surface.hemispheres().items()}
    left, right = (read_maps(of_side(given, side, "map"), side, counts[side]) for side in HEMISPHERES)
    pairs = _same_maps(list(left), list(right), given)
    for name, a, b in pairs:
        require_same_columns(left[a], right[b], f"map {name!r}")
    both = {name: of_both(surface, left[a], right[b], f"map {a!r}") for name, a, b in pairs}
    return {name: values.astype(np.float64, copy=False) for name, values in both.items()}


def _same_maps(left: list[str], right: list[str], given: Pair) -> list[tuple[str, str, str]]:
    """Return a name for each map of both hemispheres, and those that the two files give it.

    Maps of one name belong together, in whatever order they stand, and else those whose names are the same without what
    says the side; a map that stands alone in either file needs no name.
    """
    if set(left) == set(right):
        return [(name, name, name) for name in left]
    lefts, rights = ({without_side(name): name for name in names} for names in (left, right))
    if set(lefts) == set(rights) and len(lefts) == len(left) and len(rights) == len(right):
        return [(name, lefts[name], rights[name]) for name in lefts]
    if len(left) == len(right) == 1:
        return [(common_name(left[0], right[0]), left[0], right[0])]
    alone = sorted(set(left) ^ set(right))
    files = [given[side] if isinstance(given, Mapping) else given for side in HEMISPHERES]
    raise ValueError(
        f"{files[0]} has {len(left)} maps, {files[1]} has {len(right)}, and {', '.join(map(repr, alone[:3]))} "
        "in one of them alone: give the maps of both sides the same names"
    )


def require_same_columns(left: Floats, right: Floats, what: str) -> None:
    """Refuse a map of two hemispheres of which one has more columns: one column would stand for all.

    Raises
    ------
    ValueError
        Naming both shapes.
    """
    if left.shape[1:] != right.shape[1:]:
        raise ValueError(
            f"{what} has shape {left.shape} left and {right.shape} right: give both sides the same columns"
        )


def labels_of_both(surface: Surface, given: Pair) -> LabelMap:
    """Return the labels of a pair on a surface that is both hemispheres: what has one name has one label.

    Raises
    ------
    ValueError
        As `maps_of_both`.
    """
    counts = {side: len(part.mesh.vertices) for side, part in surface.hemispheres().items()}
    sides = (read_coloured_labels(of_side(given, side, "labels"), side, counts[side]) for side in HEMISPHERES)
    return labels_of_sides(surface, *sides)


def labels_of_sides(surface: Surface, left: LabelMap, right: LabelMap) -> LabelMap:
    """Return the labels of two hemispheres, with their colours, on the surface that is both.

    Raises
    ------
    ValueError
        If a side has fewer or more.
    """
    lefts, rights = joined_labels(left, right)
    keys = of_both(surface, lefts.keys, rights.keys, "labels").astype(np.int64)
    return coloured_as(LabelMap(keys, lefts.names), left, right)


def _by_name(given: Any, what: str) -> dict[str, Pair]:
    """Pairs by name: as given, or each by what the names of its two files have in common."""
    if given is None:
        return {}
    if isinstance(given, Mapping) and set(given) != set(HEMISPHERES):
        return {str(name): pair for name, pair in given.items()}
    pairs: Sequence[Any] = given if isinstance(given, list | tuple) else [given]
    names = [_name(pair, what) for pair in pairs]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise ValueError(f"two files of {what} are called {twice!r}: give each a name, as {{'a': pair, 'b': pair}}")
    return dict(zip(names, pairs, strict=True))


def _name(pair: Pair, what: str) -> str:
    if isinstance(pair, Mapping):
        return common_name(*(name_of_map(of_side(pair, side, what)) for side in HEMISPHERES))
    return name_of_map(of_side(pair, "left", what))
