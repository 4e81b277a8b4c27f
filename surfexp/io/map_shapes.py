"""Which shapes a map may have."""

from __future__ import annotations

from collections.abc import Mapping

from surfexp.contract.arrays import Floats


def check_map_shapes(maps: Mapping[str, Floats]) -> None:
    """Refuse maps that are not one number, or one row of numbers, for each vertex.

    Raises
    ------
    ValueError
        With the name of the map and its shape.
    """
    for name, values in maps.items():
        if values.ndim not in (1, 2):
            raise ValueError(f"map {name!r} has shape {values.shape}, (vertices,) or (vertices, channels) is needed")
