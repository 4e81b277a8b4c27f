"""What two solves of the ROF model prove about all weights between them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.variational.solution import Solution

# of an interval, on each of which one bound is computed
PARTS = 32


@dataclass(frozen=True, eq=False)
class Knot:
    """A solve of the normalised map.

    Parameters
    ----------
    mu : float
    difference : like the map
        u - f.
    load : like the map
        z = G^T A p of the dual field p.
    variation : float
        TV(u).
    solution : Solution
    """

    mu: float
    difference: Floats
    load: Floats
    variation: float
    solution: Solution


@dataclass(frozen=True)
class Interval:
    """What is known between two knots: quadratic forms of the interpolation parameter t, as coefficients of 1, t, t^2.

    Parameters
    ----------
    first, last : float
        The weights.
    variation, work : (2,) float64
        Bound of TV(u_t), and <z_t, f>.
    misfit, load : (3,) float64
        |u_t - f|^2 in the mass, and |z_t|^2 in its inverse.
    """

    first: float
    last: float
    variation: Floats
    work: Floats
    misfit: Floats
    load: Floats

    def parameter(self, mu: float) -> float:
        """Return the t that makes the gap at a weight least."""
        slope = self.variation[1] - self.work[1] + 0.5 * mu * self.misfit[1] + 0.5 * self.load[1] / mu
        curvature = mu * self.misfit[2] + self.load[2] / mu
        if curvature <= 0.0:
            return float(slope < 0.0)
        return float(np.clip(-slope / curvature, 0.0, 1.0))

    def energies(self, mu: float, t: float) -> tuple[float, float]:
        """Return the upper bound of the energy and the dual energy at a weight."""
        linear, square = np.array([1.0, t]), np.array([1.0, t, t * t])
        energy = float(self.variation @ linear + 0.5 * mu * (self.misfit @ square))
        return energy, float(self.work @ linear - 0.5 * (self.load @ square) / mu)

    @cached_property
    def largest_gap(self) -> float:
        """Bound of the relative gap over the whole interval: for a fixed t it is convex in the weight, part by part."""
        ends = np.geomspace(self.first, self.last, PARTS + 1)
        largest = 0.0
        for low, high in pairwise(ends):
            t = self.parameter(float(np.sqrt(low * high)))
            (energy, bound), (next_energy, next_bound) = self.energies(low, t), self.energies(high, t)
            gap = max(energy - bound, next_energy - next_bound)
            largest = max(largest, gap / max(energy, float(np.finfo(float).tiny)))
        return largest


def mixed(before: Solution, after: Solution, t: float) -> Solution:
    """The interpolated pair, from which the solve between two others begins."""
    assert before.dual is not None and after.dual is not None  # noqa: S101, narrows a type
    values = (1.0 - t) * before.values + t * after.values
    return Solution(values, np.inf, dual=(1.0 - t) * before.dual + t * after.dual)


def interval_between(before: Knot, after: Knot, mass: Floats, target: Floats) -> Interval:
    """The six numbers of two knots, as forms of the interpolation parameter."""
    masses = mass.reshape(-1, *[1] * (target.ndim - 1))
    step, load_step = after.difference - before.difference, after.load - before.load
    work = float(np.vdot(before.load, target)), float(np.vdot(load_step, target))
    return Interval(
        before.mu,
        after.mu,
        np.array([before.variation, after.variation - before.variation]),
        np.array(work),
        _squares(before.difference, step, masses),
        _squares(before.load, load_step, 1.0 / masses),
    )


def _squares(start: Floats, step: Floats, weights: Floats) -> Floats:
    """Coefficients of |start + t step|^2."""
    return np.array(
        [
            float((weights * start * start).sum()),
            float(2.0 * (weights * start * step).sum()),
            float((weights * step * step).sum()),
        ]
    )
