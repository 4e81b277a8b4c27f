"""Polygonal level sets of a piecewise linear function: their perimeters."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats, Integers
from surfexp.operators.calculus import check_length
from surfexp.operators.surface_operator import SurfaceOperator


def perimeters(operator: SurfaceOperator, values: Floats, levels: Floats) -> Floats:
    """Return the length of the level line {f = t} for every level.

    By the co-area formula the integral of this over all t is `total_variation`, exactly.

    Parameters
    ----------
    operator : SurfaceOperator
    values : (n,) float64
    levels : (k,) float64
        Ascending. A face that is constant at a level adds nothing.

    Returns
    -------
    (k,) float64
    """
    result = np.zeros(len(levels))
    values = check_length(operator.vertex_count, "vertices", values)
    _perimeters(operator.faces, operator.hat_gradients, operator.areas, values, np.asarray(levels, float), result)
    return result


@njit(cache=True, nogil=True)
def _perimeters(faces: Integers, hats: Floats, areas: Floats, values: Floats, levels: Floats, result: Floats) -> None:
    """A level line crosses a face over a length that is linear between its three values, with integral A |G f|."""
    for f in range(len(faces)):
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        b, e = values[j] - values[i], values[k] - values[i]
        if b == 0.0 and e == 0.0:
            continue
        low, high = min(0.0, b, e), max(0.0, b, e)
        middle = b + e - low - high
        x = b * hats[f, 1, 0] + e * hats[f, 2, 0]
        y = b * hats[f, 1, 1] + e * hats[f, 2, 1]
        longest = 2.0 * areas[f] * np.sqrt(x * x + y * y) / (high - low)
        for at in range(np.searchsorted(levels, low + values[i]), len(levels)):
            level = levels[at] - values[i]
            if level >= high:
                break
            if level < middle:
                result[at] += longest * (level - low) / (middle - low)
            else:
                result[at] += longest * (high - level) / (high - middle)
