"""The maps of a picture, row by row."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.contract.drawable import Drawable
from surfexp.io.hemisphere import common_name
from surfexp.io.map_files import side_by_side
from surfexp.io.quantity_of_file import quantity_named
from surfexp.mesh.surface import Surface
from surfexp.tasks.given_labels import are_labels, labels_on
from surfexp.tasks.given_map import as_map, name_of
from surfexp.tasks.map_columns import MOST_COLUMNS, columns_of, spread_over
from surfexp.tasks.map_row import MapRow
from surfexp.tasks.maps_of_file import MapsOfFile, have_own_names, is_pair, maps_of_file


def rows_of_maps(values: Any, surfaces: Sequence[Surface], most_columns: int = MOST_COLUMNS) -> list[MapRow]:
    """Return the rows of a picture: those of a result, one map for all surfaces, one for each, or rows by name.

    A map of several columns on one surface has a row for each, or for some that are spread over them. Maps of a file that have
    names of their own, as t and p, are rows by name.

    Raises
    ------
    ValueError
        If the numbers of maps and surfaces differ, or a result belongs to another number of surfaces.
    """
    count = len(surfaces)
    if isinstance(values, Drawable):
        from surfexp.tasks.drawn_results import rows_of_result  # which imports all that makes results

        return rows_of_result(values, surfaces)
    if count == 1 and (found := values if isinstance(values, MapsOfFile) else maps_of_file(surfaces[0], values)):
        if have_own_names(found):
            return _rows_by_name(found)
        if len(found) > 1:
            values = side_by_side(found, "map")
    if count == 1 and is_pair(values) and surfaces[0].right is not None:
        if are_labels(values):
            return [MapRow("", [labels_on(surfaces[0], values)])]
        return [MapRow("", [as_map(surfaces[0], values)], bar=_quantity_of_pair(values))]
    if isinstance(values, Mapping):
        return [MapRow(str(name), _of_each(one, count)) for name, one in values.items()]
    if isinstance(values, list | tuple) and count == 1 and values and not isinstance(values[0], int | float):
        names = [name_of(one) if isinstance(one, str | Path) else f"map {k}" for k, one in enumerate(values, 1)]
        return [MapRow(name, [one]) for name, one in zip(names, values, strict=True)]
    if count == 1 and (columns := columns_of(values)):
        chosen = spread_over(len(columns), most_columns)
        return [MapRow(f"column {k + 1} of {len(columns)}", [columns[k]], bar=" ") for k in chosen]
    return [MapRow("", _of_each(values, count))]


def as_columns(surface: Surface, values: Any) -> Any:
    """Return the maps of a file, or of one for each hemisphere, as columns where they are a series; anything else as it is."""
    found = values if isinstance(values, MapsOfFile) else maps_of_file(surface, values)
    return side_by_side(found, "map") if len(found) > 1 and not have_own_names(found) else values


def _rows_by_name(maps: Mapping[str, Floats]) -> list[MapRow]:
    """Return a row for each map of a file; those that are shares, as p-values, have one colour bar from 0 to 1."""
    shares = [name for name, values in maps.items() if _are_shares(values)]
    bar = ", ".join(shares)
    return [
        MapRow(name, [values], limits=(0.0, 1.0), bar=bar) if name in shares else MapRow(name, [values])
        for name, values in maps.items()
    ]


def _are_shares(values: Floats) -> bool:
    known = values[np.isfinite(values)]
    return values.ndim == 1 and bool(known.size) and bool(known.min() >= 0.0 and known.max() <= 1.0)


def _quantity_of_pair(given: Mapping[str, Any]) -> str:
    """What the files of both hemispheres are about; nothing of arrays."""
    if not all(isinstance(one, str | Path) for one in given.values()):
        return ""
    return quantity_named(common_name(*(Path(one).name for one in given.values())))


def _of_each(values: Any, count: int) -> list[Any]:
    several = isinstance(values, list | tuple) and count > 1
    if several and len(values) != count:
        raise ValueError(f"{len(values)} maps for {count} surfaces: give one for each, or one name for all")
    return list(values) if several else [values] * count
