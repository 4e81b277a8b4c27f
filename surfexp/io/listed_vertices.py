"""GIFTI maps that list the vertices of their rows, and may leave out the last ones of a surface."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surfexp.io.gifti import NODES, image_code, load_gifti


def with_last_vertices(
    path: Path, maps: Mapping[str, NDArray[Any]], count: int, missing: float = np.nan
) -> dict[str, NDArray[Any]]:
    """Return maps or labels with rows for the vertices behind the last that their file lists; as they are, where it lists none.

    Parameters
    ----------
    path : Path
        A GIFTI file that has been read.
    maps : mapping of str to (n,) or (n, c) array
    count : int
        Vertices of the surface.
    missing : float
        What these rows are.
    """
    if all(len(values) >= count for values in maps.values()):
        return dict(maps)

    if not any(array.intent == image_code(NODES) for array in load_gifti(path).darrays):
        return dict(maps)
    return {name: _longer(values, count, missing) for name, values in maps.items()}


def _longer(values: NDArray[Any], count: int, missing: float) -> NDArray[Any]:
    rest = np.full((max(count - len(values), 0), *values.shape[1:]), missing, dtype=values.dtype)
    return np.concatenate([values, rest])
