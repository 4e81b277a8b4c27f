"""A point of a triangle from two uniform numbers."""

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True)
def point_in_triangle(corners: NDArray[np.float64], s: float, t: float) -> NDArray[np.float64]:
    """Return a point that is uniform in a triangle if s and t are uniform in [0, 1].

    Parameters
    ----------
    corners : (3, 3) float64
        Corners by row.
    s, t : float

    Returns
    -------
    (3,) float64
    """
    root = np.sqrt(s)
    return (1.0 - root) * corners[0] + root * ((1.0 - t) * corners[1] + t * corners[2])
