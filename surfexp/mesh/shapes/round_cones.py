"""Bodies built of round cones, joined smoothly."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats


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
        for k in range(len(cones)):
            # written out by components: array temporaries cost ten times more
            ax, ay, az = cones[k, 3] - cones[k, 0], cones[k, 4] - cones[k, 1], cones[k, 5] - cones[k, 2]
            x, y, z = points[i, 0] - cones[k, 0], points[i, 1] - cones[k, 1], points[i, 2] - cones[k, 2]
            along = min(max((ax * x + ay * y + az * z) / (ax * ax + ay * ay + az * az), 0.0), 1.0)
            away = np.sqrt((x - along * ax) ** 2 + (y - along * ay) ** 2 + (z - along * az) ** 2)
            distance = away - (cones[k, 6] + along * (cones[k, 7] - cones[k, 6]))
            overlap = max(cones[k, 8] - abs(union - distance), 0.0)
            union = min(union, distance) - overlap**2 / (4.0 * cones[k, 8])
        values[i] = union
    return values
