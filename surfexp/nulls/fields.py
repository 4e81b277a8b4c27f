"""Gaussian random fields on a surface, with a correlation length that is known and may vary."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.sparse import csr_array, diags_array

from surfexp.contract.arrays import Floats
from surfexp.operators.assembly import stiffness
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.smoothing.geodesic_gaussian import WIDTH_OF_DEVIATION
from surfexp.smoothing.heat_polynomial import heat_polynomial

TOLERANCE = 1e-4
COLUMNS_AT_ONCE = 64


def gaussian_fields(operator: SurfaceOperator, width: float | Floats, count: int, seed: int = 0) -> Floats:
    """Return independent Gaussian fields of variance 1 at each vertex whose correlation has a full width at half maximum.

    White noise of the surface, xi / sqrt(m), runs through the heat flow exp(-t L). In the plane the correlation of the
    result is exp(-d^2 / 8 t), whose half width gives t = (width / 2.355)^2 / 4. A width that varies over the surface is the
    heat flow of the metric rho g with rho = (largest width / width)^2: its energy is that of g, its mass rho m.

    Parameters
    ----------
    operator : SurfaceOperator
    width : float or (n,) float64
        In the unit of the surface. The mesh makes it narrower, by 1 % at seven edges, 8 % at four and a quarter at two and a half;
        below two edges the field is nearly white noise of the vertices.
    count : int
        Number of fields, c.
    seed : int

    Returns
    -------
    (n, c) float64
        Divided by the standard deviation at each vertex, which is computed and not estimated, to 1e-4.

    Raises
    ------
    ValueError
        If a width or the count is not positive, or there is not one width for each vertex.
    """
    if count < 1:
        raise ValueError(f"count is {count}, at least 1 field must be asked for")
    stretched, time = _metric_of(operator, width)
    n = len(stretched.mass)
    noise = np.random.default_rng(seed).standard_normal((n, count))
    return _flow(stretched, noise, time) / np.sqrt(_variance(stretched, time))[:, None]


def _metric_of(operator: SurfaceOperator, width: float | Floats) -> tuple[SurfaceOperator, float]:
    """The operator of the metric in which the width is constant, and the time of the flow."""
    n = operator.vertex_count
    widths = np.asarray(width, dtype=np.float64)
    if widths.shape not in ((), (n,)) or not (widths > 0.0).all() or not np.isfinite(widths).all():
        raise ValueError(f"width has shape {widths.shape} and least value {widths.min():g}: one, or {n}, all positive")
    largest = float(widths.max())
    time = 0.25 * (largest / WIDTH_OF_DEVIATION) ** 2
    if widths.ndim == 0:
        return operator, time
    # rho >= 1, so that the bound of the largest eigenvalue, which is that of g, holds
    mass = csr_array(diags_array((largest / widths) ** 2 * operator.mass))
    return replace(operator, matrices=(stiffness(operator), mass)), time


def _flow(operator: SurfaceOperator, noise: Floats, time: float) -> Floats:
    return heat_polynomial(operator, noise / np.sqrt(operator.mass)[:, None], time, TOLERANCE)[0]


def _variance(operator: SurfaceOperator, time: float) -> Floats:
    """Sums of squares of the rows of exp(-t L) M^(-1/2), some columns at a time."""
    n = operator.vertex_count
    total = np.zeros(n)
    for start in range(0, n, COLUMNS_AT_ONCE):
        size = min(COLUMNS_AT_ONCE, n - start)
        unit = np.zeros((n, size))
        unit[start + np.arange(size), np.arange(size)] = 1.0
        total += (_flow(operator, unit, time) ** 2).sum(axis=1)
    return total
