"""Minimisers of the ROF model for every weight of a range, each with a proved gap, from solves at a few weights.

Between two weights a minimiser and its dual field are interpolated. Total variation is convex and the dual constraint is
convex, so the interpolated pair is feasible, and an upper bound of its energy and its dual energy are known from six numbers
of the two solves. Where the gap that follows is too large, the interval is cut in two.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.operators.calculus import adjoint_gradient, total_variation
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.own_unit import OwnUnit, own_unit
from surfexp.variational.separable_quadratic import check_positive, rof
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.newton import newton
from surfexp.variational.solvers.primal_dual import primal_dual

# share of the tolerance that solves may use up; parts of an interval on which a bound is computed
OF_SOLVES, PARTS = 0.25, 32
LARGEST_COUNT = 400

Progress = Callable[[int, float], None]


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


@dataclass(frozen=True, eq=False)
class RofPath:
    """Minimisers of TV(u) + mu/2 |u - f|^2 for every mu of a range.

    Parameters
    ----------
    operator : SurfaceOperator
    image : (n,) or (n, c) float64
    own : OwnUnit
        The unit in which the solves were.
    knots : tuple of Knot
        By growing weight, in that unit.
    intervals : tuple of Interval
        Between them.
    """

    operator: SurfaceOperator
    image: Floats
    own: OwnUnit
    knots: tuple[Knot, ...]
    intervals: tuple[Interval, ...]

    @property
    def mus(self) -> Floats:
        """(k,) weights that were solved."""
        return np.array([knot.mu for knot in self.knots]) / self.own.unit

    @property
    def largest_gap(self) -> float:
        """Proved bound of the relative gap at every weight of the range."""
        return max(interval.largest_gap for interval in self.intervals)

    def at(self, mu: float) -> Solution:
        """Return the interpolated minimiser at a weight, with its own energy, lower bound and gap.

        Parameters
        ----------
        mu : float
            Within the range.

        Raises
        ------
        ValueError
            If the weight is outside of the range.
        """
        mus = self.mus
        if not mus[0] <= mu <= mus[-1]:
            raise ValueError(f"mu = {mu:g} is outside of the path, {mus[0]:g} to {mus[-1]:g}")
        place = int(np.clip(np.searchsorted(mus, mu) - 1, 0, len(self.intervals) - 1))
        before, after = self.knots[place], self.knots[place + 1]
        t = self.intervals[place].parameter(mu * self.own.unit)
        values = self.own.normalised(self.image) + (1.0 - t) * before.difference + t * after.difference
        load = (1.0 - t) * before.load + t * after.load
        fidelity = rof(self.operator.mass, self.own.normalised(self.image), mu * self.own.unit)
        energy = total_variation(self.operator, values) + fidelity.value(values)
        bound = fidelity.dual_value(load)
        gap = max(energy - bound, 0.0)
        return Solution(
            self.own.restored(values),
            energy * self.own.unit,
            lower_bound=bound * self.own.unit,
            relative_gap=gap / fidelity.gap_scale(energy, bound),
            error_bound=float(np.sqrt(2.0 * gap / (mu * self.own.unit))) * self.own.unit,
            model="rof",
            solver="path",
        )


def rof_path(
    operator: SurfaceOperator,
    image: Floats,
    least: float,
    most: float,
    *,
    tolerance: float = 1e-3,
    progress: Progress | None = None,
) -> RofPath:
    """Solve TV(u) + mu/2 |u - f|^2 at as many weights as it takes to prove a gap at all of them.

    Parameters
    ----------
    operator : SurfaceOperator
    image : (n,) or (n, c) float64
    least, most : float
        Ends of the range of mu.
    tolerance : float
        Largest relative gap at any weight.
    progress : callable, optional
        Receives the number of solves and the largest gap that is left.

    Returns
    -------
    RofPath

    Raises
    ------
    ValueError
        If the range is empty, or 400 solves do not reach the tolerance.

    Examples
    --------
    >>> from surfexp.mesh.shapes.icosphere import icosphere
    >>> from surfexp.operators.fem import fem
    >>> mesh = icosphere(2).mesh
    >>> path = rof_path(fem(mesh), mesh.vertices[:, 2], 1.0, 100.0, tolerance=1e-2)
    >>> path.at(12.3).relative_gap < 1e-2
    True
    """
    check_positive("least", least)
    if not least < most:
        raise ValueError(f"the range of mu is {least:g} to {most:g}, it must grow")
    own = own_unit(image)
    target = own.normalised(image)

    def solved(mu: float, start: Solution | None) -> Knot:
        fidelity, own_tolerance = rof(operator.mass, target, mu), OF_SOLVES * tolerance
        if start is None and target.ndim == 1:  # from afar Newton's method takes half the time
            solution = newton(fidelity, operator, tolerance=own_tolerance)
        else:
            solution = primal_dual(fidelity, operator, start, tolerance=own_tolerance, iteration_limit=100_000)
        assert solution.dual is not None  # noqa: S101, narrows a type
        load = adjoint_gradient(operator, solution.dual)
        return Knot(mu, solution.values - target, load, total_variation(operator, solution.values), solution)

    def between(before: Knot, after: Knot) -> Interval:
        return _interval(before, after, operator.mass, target)

    knots = [solved(mu * own.unit, None) for mu in (least, most)]
    intervals = [between(*knots)]
    while (worst := max(intervals, key=lambda interval: interval.largest_gap)).largest_gap > tolerance:
        if progress is not None:
            progress(len(knots), worst.largest_gap)
        if len(knots) == LARGEST_COUNT:
            raise ValueError(
                f"{LARGEST_COUNT} solves leave a relative gap of {worst.largest_gap:.1e}, tolerance = {tolerance:g}: "
                "take a larger one, or a shorter range"
            )
        place = intervals.index(worst)
        before, after = knots[place], knots[place + 1]
        mu = float(np.sqrt(before.mu * after.mu))
        middle = solved(mu, _mixed(before.solution, after.solution, worst.parameter(mu)))
        knots.insert(place + 1, middle)
        intervals[place : place + 1] = [between(before, middle), between(middle, after)]
    return RofPath(operator, image, own, tuple(knots), tuple(intervals))


def _mixed(before: Solution, after: Solution, t: float) -> Solution:
    """The interpolated pair, from which the solve between two others begins."""
    assert before.dual is not None and after.dual is not None  # noqa: S101, narrows a type
    values = (1.0 - t) * before.values + t * after.values
    return Solution(values, np.inf, dual=(1.0 - t) * before.dual + t * after.dual)


def _interval(before: Knot, after: Knot, mass: Floats, target: Floats) -> Interval:
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
