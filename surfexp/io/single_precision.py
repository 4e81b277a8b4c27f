"""What a format of single precision can hold; the rest is refused instead of becoming inf, zero or one point quietly."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats, Integers

SMALLEST, LARGEST = float(np.finfo(np.float32).tiny), float(np.finfo(np.float32).max)


def check_single_precision(values: Floats, what: str) -> Floats:
    """Return values that single precision can hold; NaN is one of them.

    Raises
    ------
    ValueError
        If a value is beyond its range, or all are so small that it has no digits for them.
    """
    largest = float(np.nanmax(np.abs(values), initial=0.0))
    if largest > LARGEST or 0 < largest < SMALLEST:
        raise ValueError(
            f"the largest value of {what} is {largest:g}, single precision goes from {SMALLEST:.2g} to {LARGEST:.2g}:"
            f" change the unit, or write .vtp or .npz"
        )
    return values


def check_single_precision_maps(maps: dict[str, Floats]) -> dict[str, Floats]:
    """Return maps that single precision can hold; otherwise the first that it cannot is named in a ValueError."""
    return {name: check_single_precision(values, f"the map {name!r}") for name, values in maps.items()}


def check_single_precision_points(points: Floats, faces: Integers) -> None:
    """Refuse points whose rounding would leave an edge of a face without length.

    Raises
    ------
    ValueError
        Naming the first such edge, or the largest coordinate if that is out of range.
    """
    rounded = check_single_precision(points, "the vertices").astype(np.float32)
    ends, others = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    lost = (rounded[ends] == rounded[others]).all(axis=1) & (points[ends] != points[others]).any(axis=1)
    if lost.any():
        at = int(np.flatnonzero(lost)[0])
        raise ValueError(
            f"in single precision {int(lost.sum())} of {len(lost)} edges have no length, as that from vertex {ends[at]} to"
            f" {others[at]}: move the surface to the origin, or write .ply, .vtp or .npz"
        )
