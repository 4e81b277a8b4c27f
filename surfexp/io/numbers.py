"""Checks of arrays that come out of files: real, of the promised shape, in range."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats, Integers

# areas are products of two lengths: beyond these they overflow or vanish in double precision
LARGEST_COORDINATE, LARGEST_BYTES = 1e75, 4 << 30


def real_array(array: NDArray[Any], what: str) -> Floats:
    """Return an array as float64 if it holds real numbers or booleans, NaN allowed.

    Raises
    ------
    ValueError
        If it is complex, a date, text, structured or of objects, or a value is infinite.
    """
    kind = "structured" if array.dtype.names else str(array.dtype)
    if array.dtype.names or array.dtype.kind not in "buif":
        raise ValueError(f"{what} is an array of type {kind}, real numbers are needed")
    values = np.asarray(array, dtype=np.float64)
    infinite = int(np.isinf(values).sum())
    if infinite:
        raise ValueError(f"{what} has {infinite} infinite values of {values.size}; write NaN where nothing is known")
    return values


def index_array(array: NDArray[Any], what: str) -> Integers:
    """Return an array as int64 if every number is whole.

    Raises
    ------
    ValueError
        If a number is fractional, not finite or beyond 2^53.
    """
    if array.dtype.kind in "iu":
        return np.asarray(array, dtype=np.int64)
    values = real_array(array, what)
    bad = ~(np.isfinite(values) & (np.abs(values) < 2.0**53) & (values == np.floor(values)))
    if bad.any():
        raise ValueError(f"{what} has the value {values[bad].ravel()[0]:g}, whole numbers are needed")
    return values.astype(np.int64)


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
            f"a coordinate is {far:g}, the largest with a finite area is {LARGEST_COORDINATE:g}: change the unit"
        )
    if len(corners) and not 0 <= corners.min() <= corners.max() < len(points):
        bad = corners.max() if corners.min() >= 0 else corners.min()
        raise ValueError(f"a face names vertex {bad}, the vertices are 0..{len(points) - 1}")
    return points, corners
