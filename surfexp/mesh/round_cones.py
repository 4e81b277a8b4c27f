"""Bodies built of round cones, joined smoothly."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.mesh.triangle_mesh import Floats


@njit(cache=True, nogil=True)
def round_cones(points: Floats, cones: Floats) -> Floats:
    """Distance-like function of a smooth union of round cones, negative inside.

    Parameters
    ----------
    points : (n, 3) float64
    cones : (k, 9) float64
        For each: start (3), end (3), radius at the start and at the end, and the width over which it melts into the
        union of those before it.
    """
    values = np.empty(len(points))
    for i in range(len(points)):
        union = 1e30
        for cone in cones:
            axis, offset = cone[3:6] - cone[0:3], points[i] - cone[0:3]
            along = min(max((axis * offset).sum() / (axis**2).sum(), 0.0), 1.0)
            away = offset - along * axis
            distance = np.sqrt((away**2).sum()) - (cone[6] + along * (cone[7] - cone[6]))
            overlap = max(cone[8] - abs(union - distance), 0.0)
            union = min(union, distance) - overlap**2 / (4.0 * cone[8])
        values[i] = union
    return values
