"""Checks of arrays that come out of files: real, of the promised shape, in range."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.given_arrays import index_array as index_array
from surfexp.mesh.given_arrays import real_array as real_array
from surfexp.mesh.validate import LARGEST_COORDINATE

LARGEST_BYTES = 4 << 30


def checked_geometry(vertices: NDArray[Any], faces: NDArray[Any]) -> tuple[Floats, Integers]:
    """Return vertices (n, 3) and faces (m, 3), both well formed.

    Raises
    ------
    ValueError
        If a shape, a coordinate or an index is unfit; NaN vertices are left to `surfexp.mesh.validate`.
    """
    points, corners = real_array(np.asarray(vertices), "the vertices"), index_array(np.asarray(faces), "the faces")
    for name, array in (("vertices", points), ("faces", corners)):
        if array.ndim != 2 or array.shape[1] != 3:
            raise ValueError(f"its {name} have shape {array.shape}, (count, 3) is needed")
    far = float(np.nanmax(np.abs(points), initial=0.0))
    if far > LARGEST_COORDINATE:
        raise ValueError(
            f"a coordinate is {far:g}, the largest with a finite volume is {LARGEST_COORDINATE:g}: change the unit"
        )
    if len(corners) and not 0 <= corners.min() <= corners.max() < len(points):
        bad = corners.max() if corners.min() >= 0 else corners.min()
        raise ValueError(f"a face names vertex {bad}, the vertices are 0..{len(points) - 1}")
    return points, corners
