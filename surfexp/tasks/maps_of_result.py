"""The maps that a result consists of."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.given_arrays import map_array
from surfexp.tasks.denoised_map import DenoisedMap
from surfexp.tasks.mode_numbers import mode_numbers


def maps_of(what: Any) -> dict[str, Floats]:
    """Return the maps (n,) or (n, c) that a result consists of, by name.

    Raises
    ------
    ValueError
        If it has none.
    """
    if isinstance(what, Mapping):
        return {str(name): _written_map(values, f"map {str(name)!r}") for name, values in what.items()}
    if isinstance(named := getattr(what, "maps", None), Mapping):
        return dict(named)
    if hasattr(what, "vectors"):
        columns = zip(mode_numbers(what), what.vectors.T, strict=True)
        return {f"mode {k}": np.ascontiguousarray(column) for k, column in columns}
    if is_dataclass(what) and not hasattr(what, "values"):
        held = [one.name for one in fields(what) if isinstance(getattr(what, one.name), np.ndarray)]
        rest = f", such as one of its {', '.join(held)}" if held else ""
        raise ValueError(
            f"a {type(what).__name__} is no map of the surface: give an array{rest}, or a result that is one"
        )
    array = _written_map(getattr(what, "values", what), f"{type(what).__name__} given as a map")
    return {what.name if isinstance(what, DenoisedMap) else "map": array}


def _written_map(given: Any, what: str) -> Floats:
    array = map_array(given, what)
    if array.ndim not in (1, 2):
        raise ValueError(f"{what} has shape {array.shape}, one row a vertex is needed")
    return array
