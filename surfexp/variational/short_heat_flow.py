"""Implicit heat flow over a few edges by a polynomial: what a factorisation gives, without one."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.fft import dct
from scipy.sparse import csr_array, diags_array

from surfexp.contract.arrays import Floats
from surfexp.linalg.chebyshev_sums import chebyshev_sums
from surfexp.linalg.ldlt import LDLT, ldlt
from surfexp.operators.assembly import stiffness
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.separable_quadratic import check_positive

# beyond it a factorisation costs no more on any surface that was tried
LARGEST_DEGREE = 200
LEFT_OUT = 1e-14


@dataclass(frozen=True, eq=False)
class ShortHeatFlow:
    """What `heat_flow` returns, to rounding: by a polynomial of the Laplacian where one of degree 200 suffices.

    k implicit steps are ``(1 + t L / k)^-k f`` with ``L = M^-1 S``. No eigenvalue of L exceeds its largest row sum of moduli
    (Gershgorin), and on that interval the Chebyshev series of the rational function falls geometrically: a flow over
    four edges of a good mesh takes some forty terms. Where slivers make the interval long, the steps are factorised, once.

    Parameters
    ----------
    operator : SurfaceOperator
    time : float
        In squared units of length.
    steps : int

    Raises
    ------
    ValueError
        If the time is not positive.
    """

    operator: SurfaceOperator
    time: float
    steps: int = 10

    def __post_init__(self) -> None:
        check_positive("time", self.time)

    @cached_property
    def _polynomial(self) -> tuple[csr_array, float, Floats | None]:
        """The Laplacian, a bound of its eigenvalues, and the series; none where it would be long."""
        laplacian = csr_array(diags_array(1.0 / self.operator.mass) @ stiffness(self.operator))
        largest = float(abs(laplacian).sum(axis=1).max())
        return laplacian, largest, series_of_steps(0.5 * self.time * largest / self.steps, self.steps)

    @cached_property
    def _factors(self) -> LDLT:
        return ldlt(diags_array(self.operator.mass) + self.time / self.steps * stiffness(self.operator))

    def __call__(self, values: Floats) -> Floats:
        """Return the flow of values (n,) or (n, c)."""
        laplacian, largest, series = self._polynomial
        if series is None:
            return self.by_steps(values)
        return chebyshev_sums(laplacian, largest, values, [series])[0]

    def by_steps(self, values: Floats) -> Floats:
        """Return the same by factorised steps, which keep positive what is positive where rounding would decide."""
        mass = self.operator.mass.reshape(-1, *[1] * (values.ndim - 1))
        for _ in range(self.steps):
            values = self._factors.solve(mass * values)
        return values


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
