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


def scalar_channels(maps: dict[str, Floats]) -> dict[str, Floats]:
    """Return maps of one number a vertex: the channels of others by name and number."""
    flat: dict[str, Floats] = {}
    for name, values in maps.items():
        columns = {name: values} if values.ndim == 1 else {f"{name} {k}": values[:, k] for k in range(values.shape[1])}
        flat |= columns
    return flat
