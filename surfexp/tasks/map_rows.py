"""The maps of a picture, row by row."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from surfexp.contract.drawable import Drawable
from surfexp.mesh.surface import Surface
from surfexp.tasks.inputs import name_of
from surfexp.tasks.map_columns import MOST_COLUMNS, columns_of, spread_over
from surfexp.tasks.map_row import MapRow


def rows_of_maps(values: Any, surfaces: Sequence[Surface], most_columns: int = MOST_COLUMNS) -> list[MapRow]:
    """Return the rows of a picture: those of a result, one map for all surfaces, one for each, or rows by name.

    A map of several columns on one surface has a row for each, or for some that are spread over them.

    Raises
    ------
    ValueError
        If the numbers of maps and surfaces differ, or a result belongs to another number of surfaces.
    """
    count = len(surfaces)
    if isinstance(values, Drawable):
        from surfexp.tasks.drawn_results import rows_of_result  # which imports all that makes results

        return rows_of_result(values, surfaces)
    if isinstance(values, Mapping):
        return [MapRow(str(name), _of_each(one, count)) for name, one in values.items()]
    if isinstance(values, list | tuple) and count == 1 and values and not isinstance(values[0], int | float):
        names = [name_of(one) if isinstance(one, str | Path) else f"map {k}" for k, one in enumerate(values, 1)]
        return [MapRow(name, [one]) for name, one in zip(names, values, strict=True)]
    if count == 1 and (columns := columns_of(values)):
        chosen = spread_over(len(columns), most_columns)
        return [MapRow(f"column {k + 1} of {len(columns)}", [columns[k]], bar=" ") for k in chosen]
    return [MapRow("", _of_each(values, count))]


def _of_each(values: Any, count: int) -> list[Any]:
    several = isinstance(values, list | tuple) and count > 1
    if several and len(values) != count:
        raise ValueError(f"{len(values)} maps for {count} surfaces: give one for each, or one name for all")
    return list(values) if several else [values] * count
