"""A row of maps in a picture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from surfexp.skeleton.skeleton import Skeleton


@dataclass(frozen=True, eq=False)
class MapRow:
    """A row of a picture.

    Parameters
    ----------
    name : str
    maps : list
        One for each surface: what `plot` takes.
    limits, colormap, levels, skeleton, bar
        Colours, level lines, a skeleton and the text of the colour bar, taken where `plot` is not told otherwise.
    quantity : str
        Name of the map whose unit it has, where its own name does not tell.
    """

    name: str
    maps: list[Any]
    limits: tuple[float, float] | None = None
    colormap: str | None = None
    levels: tuple[float, ...] = ()
    skeleton: Skeleton | None = None
    bar: str = ""
    quantity: str = ""
