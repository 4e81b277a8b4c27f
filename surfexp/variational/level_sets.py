"""Polygonal level sets of a piecewise linear function: perimeters and the best threshold."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.mesh.triangle_mesh import Floats, Integers
from surfexp.operators.calculus import check_length
from surfexp.operators.surface_operator import SurfaceOperator

THRESHOLD_LIMIT = 256


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


def best_threshold(operator: SurfaceOperator, values: Floats, slope: Floats) -> tuple[float, float]:
    """Return the threshold t in (0, 1) with the least Per{phi > t} + sum_i m_i r_i [phi_i > t], and that energy.

    Thresholds lie midway between neighbouring values of phi, thinned to 256. The quadrature is that of the energy, so the
    least over all of them is at most the energy of phi.

    Parameters
    ----------
    operator : SurfaceOperator
    values : (n,) float64
        In [0, 1].
    slope : (n,) float64
        mu r.
    """
    knots = np.unique(np.concatenate([values, [0.0, 1.0]]))
    levels = 0.5 * (knots[1:] + knots[:-1])
    if len(levels) > THRESHOLD_LIMIT:
        levels = levels[np.linspace(0, len(levels) - 1, THRESHOLD_LIMIT).astype(int)]
    order = np.argsort(values, kind="stable")
    above = np.concatenate([np.cumsum((operator.mass * slope)[order][::-1])[::-1], [0.0]])
    energies = perimeters(operator, values, levels) + above[np.searchsorted(values[order], levels, side="right")]
    best = int(np.argmin(energies))
    return float(levels[best]), float(energies[best])


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
