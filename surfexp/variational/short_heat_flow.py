"""Implicit heat flow over a few edges by a polynomial: what a factorisation gives, without one."""

from __future__ import annotations

import numpy as np
from scipy.fft import dct
from scipy.sparse import csr_array, diags_array

from surfexp.contract.arrays import Floats
from surfexp.operators.assembly import stiffness
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.separable_quadratic import check_positive
from surfexp.variational.surface_flows import heat_flow

# beyond it a factorisation costs no more on any surface that was tried
LARGEST_DEGREE = 200
LEFT_OUT = 1e-14


def short_heat_flow(operator: SurfaceOperator, values: Floats, time: float, steps: int = 10) -> Floats:
    """Return what `heat_flow` returns, to rounding: by a polynomial of the Laplacian where one of degree 200 suffices.

    k implicit steps are ``(1 + t L / k)^-k f`` with ``L = M^-1 S``. No eigenvalue of L exceeds its largest row sum of moduli
    (Gershgorin), and on that interval the Chebyshev series of the rational function falls geometrically: a flow over
    four edges of a good mesh takes some forty terms. Where slivers make the interval long, the steps are factorised.

    Parameters
    ----------
    operator : SurfaceOperator
    values : (n,) or (n, c) float64
    time : float
        In squared units of length.
    steps : int

    Returns
    -------
    like `values`

    Raises
    ------
    ValueError
        If the time is not positive.
    """
    check_positive("time", time)
    laplacian = csr_array(diags_array(1.0 / operator.mass) @ stiffness(operator))
    largest = float(abs(laplacian).sum(axis=1).max())
    coefficients = series_of_steps(0.5 * time * largest / steps, steps)
    if coefficients is None:
        return heat_flow(operator, values, time, steps)

    def shifted(field: Floats) -> Floats:
        return (2.0 / largest) * (laplacian @ field) - field

    before, now = values, shifted(values)
    total = coefficients[0] * before + coefficients[1] * now
    for coefficient in coefficients[2:]:
        before, now = now, 2.0 * shifted(now) - before
        total += coefficient * now
    return total


def series_of_steps(half: float, steps: int) -> Floats | None:
    """Return the Chebyshev coefficients of ``(1 + half (1 + x))^-steps`` on [-1, 1] to 1e-14, nothing if there are too many.

    Parameters
    ----------
    half : float
        Half of the time of a step times the largest eigenvalue.
    steps : int

    Returns
    -------
    (k,) float64 or None
        At least 2.
    """
    for terms in (LARGEST_DEGREE // 4, LARGEST_DEGREE // 2, LARGEST_DEGREE):
        points = np.cos(np.pi * (np.arange(terms) + 0.5) / terms)
        found = dct((1.0 + half * (1.0 + points)) ** -steps) / terms
        found[0] *= 0.5
        kept = max(2, 1 + int(np.flatnonzero(np.abs(found) > LEFT_OUT)[-1]))
        if kept <= terms - terms // 8:
            return np.asarray(found[:kept])
    return None
