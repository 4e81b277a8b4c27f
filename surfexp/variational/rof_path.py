"""Minimisers of the ROF model for every weight of a range, each with a proved gap, from solves at a few weights.

Between two weights a minimiser and its dual field are interpolated. Total variation is convex and the dual constraint is
convex, so the interpolated pair is feasible, and an upper bound of its energy and its dual energy are known from six numbers
of the two solves. Where the gap that follows is too large, the interval is cut in two.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.operators.calculus import adjoint_gradient, total_variation
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.own_unit import OwnUnit, own_unit
from surfexp.variational.rof_interval import Interval, Knot, interval_between, mixed
from surfexp.variational.separable_quadratic import check_positive, rof
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.newton import newton
from surfexp.variational.solvers.primal_dual import primal_dual

# share of the tolerance that solves may use up
OF_SOLVES = 0.25
LARGEST_COUNT = 400
# with so many solves the number that is foreseen was below the one that it took, for smooth, noisy and steep maps
FORESEEN_FROM = 32

Progress = Callable[[int, float], None]


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

    def place(self, mu: float) -> tuple[int, float]:
        """Return the interval of a weight, and how far between its knots the interpolated minimiser lies.

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
        return place, self.intervals[place].parameter(mu * self.own.unit)

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
        place, t = self.place(mu)
        before, after = self.knots[place], self.knots[place + 1]
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
        If the range is empty, or 400 solves do not reach the tolerance, which is foreseen from the first 32.

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
        return interval_between(before, after, operator.mass, target)

    knots = [solved(mu * own.unit, None) for mu in (least, most)]
    intervals = [between(*knots)]
    while (worst := max(intervals, key=lambda interval: interval.largest_gap)).largest_gap > tolerance:
        if progress is not None:
            progress(len(knots), worst.largest_gap)
        needed = _solves_needed(intervals, tolerance) if len(knots) >= FORESEEN_FROM else len(knots)
        if max(needed, len(knots)) >= LARGEST_COUNT:
            raise ValueError(
                f"{len(knots)} solves leave a relative gap of {worst.largest_gap:.1e}, tolerance = {tolerance:g} needs about "
                f"{max(needed, len(knots) + 1):.0f}, at most {LARGEST_COUNT} are done: take a larger one, or a shorter range"
            )
        place = intervals.index(worst)
        before, after = knots[place], knots[place + 1]
        mu = float(np.sqrt(before.mu * after.mu))
        middle = solved(mu, mixed(before.solution, after.solution, worst.parameter(mu)))
        knots.insert(place + 1, middle)
        intervals[place : place + 1] = [between(before, middle), between(middle, after)]
    return RofPath(operator, image, own, tuple(knots), tuple(intervals))


def _solves_needed(intervals: list[Interval], tolerance: float) -> float:
    """About how many solves the tolerance takes: what interpolation adds to a gap falls with the square of an interval."""
    added = (1.0 - OF_SOLVES) * tolerance
    return sum(max(1.0, max(one.largest_gap - OF_SOLVES * tolerance, 0.0) ** 0.5 / added**0.5) for one in intervals)
