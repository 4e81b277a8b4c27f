"""GIFTI maps that list the vertices of their rows, and may leave out the last ones of a surface."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.io.gifti import NODES, image_code


def with_last_vertices(path: Path, maps: dict[str, Floats], count: int) -> dict[str, Floats]:
    """Return maps with NaN for the vertices behind the last that their file lists; as they are, where it lists none.

    Parameters
    ----------
    path : Path
        A GIFTI file that has been read.
    maps : dict of str to (n,) or (n, c) float64
    count : int
        Vertices of the surface.
    """
    if all(len(values) >= count for values in maps.values()):
        return maps
    import nibabel

    if not any(array.intent == image_code(NODES) for array in nibabel.load(path).darrays):
        return maps
    return {name: _longer(values, count) for name, values in maps.items()}


def _longer(values: Floats, count: int) -> Floats:
    missing = np.full((max(count - len(values), 0), *values.shape[1:]), np.nan)
    return np.concatenate([values, missing])
