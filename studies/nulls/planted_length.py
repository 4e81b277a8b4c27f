"""Correlation lengths that vary along a surface."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats


def widths_along(vertices: Floats, width: float, ratio: float, axis: int = 1) -> Floats:
    """Return widths that grow by a factor from one end of a surface to the other, as a geometric sequence.

    Parameters
    ----------
    vertices : (n, 3) float64
    width : float
        Half way between the ends.
    ratio : float
        Largest over least width.
    axis : {0, 1, 2}
        Coordinate along which they grow; 1 is from back to front in the brain.

    Returns
    -------
    (n,) float64

    Raises
    ------
    ValueError
        If the width is not positive or the ratio below 1, or the surface has no extent along the axis.
    """
    place = vertices[:, axis] - vertices[:, axis].min()
    if not width > 0.0 or not ratio >= 1.0 or not place.max() > 0.0:
        raise ValueError(
            f"width is {width:g}, ratio {ratio:g} and the extent {place.max():g}: a positive width, a ratio of 1 or more and "
            "a positive extent are needed"
        )
    return np.asarray(width * ratio ** (place / place.max() - 0.5))
