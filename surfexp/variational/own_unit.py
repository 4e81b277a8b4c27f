"""Denoising in the map's own unit, so that no offset and no unit of the map enters the steps, the gap or the rounding."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import wraps
from typing import Any, TypeGuard, TypeVar, cast

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.fidelity import Fidelity
from surfexp.variational.separable_quadratic import SeparableQuadratic
from surfexp.variational.solution import Solution

ENERGIES = ("energy", "lower_bound", "gap")
# options of solvers that are numbers in the unit of the map
WITH_UNIT = ("step", "penalty")

Solver = TypeVar("Solver", bound=Callable[..., Solution])


@dataclass(frozen=True, eq=False)
class OwnUnit:
    """The middle and half the range of a map; of several channels each its middle, and the largest half range.

    Parameters
    ----------
    centre : () or (c,) float64
    unit : float
        1 for a constant map.
    """

    centre: Floats
    unit: float

    def normalised(self, values: Floats) -> Floats:
        """Return values of the map in its own unit."""
        return (values - self.centre) / self.unit

    def restored(self, values: Floats) -> Floats:
        """Return normalised values in the unit of the map."""
        return np.asarray(self.centre + self.unit * values)


def own_unit(values: Floats) -> OwnUnit:
    """Return the unit of (n,) or (n, c) values, which follows a change ``a f + c`` of the map."""
    halves = 0.5 * values.min(axis=0), 0.5 * values.max(axis=0)
    unit = float(np.max(halves[1] - halves[0]))
    return OwnUnit(np.asarray(halves[0] + halves[1]), unit if unit > 0 else 1.0)


def odd_sign(normalised: Floats) -> float:
    """Return the sign of the first value that is not 0, or 1: of the negative map it is the other one."""
    return -1.0 if normalised[np.argmax(normalised != 0)] < 0 else 1.0


def normalised_fidelity(fidelity: SeparableQuadratic, own: OwnUnit) -> SeparableQuadratic:
    """Return the data term of the normalised map: its minimiser is the normalised one, its energy that over the unit."""
    return replace(fidelity, weight=own.unit * fidelity.weight, target=own.normalised(fidelity.target))


def restored_solution(solution: Solution, own: OwnUnit) -> Solution:
    """Return the solution of a normalised map with its values, energies and bound of the error in the unit of the map."""
    unit = own.unit
    metrics = {name: number * unit if name in ENERGIES else number for name, number in solution.metrics.items()}
    bound = None if solution.error_bound is None else solution.error_bound * unit
    if bound is not None:
        metrics["error_bound"] = bound
    return replace(
        solution,
        values=own.restored(solution.values),
        energy=solution.energy * unit,
        lower_bound=None if solution.lower_bound is None else solution.lower_bound * unit,
        error_bound=bound,
        history=solution.history | {"energy": unit * solution.history["energy"]},
        metrics=metrics,
    )


def in_own_unit(solver: Solver) -> Solver:
    """Let a solver of TV + H work on the normalised map where H depends on nothing but the distance to it.

    Published operators, and steps or penalties that are given in the unit of the map, leave the map as it is.
    """

    @wraps(solver)
    def solve(fidelity: Fidelity, operator: SurfaceOperator, start: Solution | None = None, **options: Any) -> Solution:
        given = any(options.get(name) is not None for name in WITH_UNIT)
        if given or operator.averaged_gradient is not None or not _is_distance(fidelity):
            return solver(fidelity, operator, start, **options)
        own = own_unit(fidelity.target)
        if start is not None:
            start = replace(start, values=own.normalised(start.values))
        return restored_solution(solver(normalised_fidelity(fidelity, own), operator, start, **options), own)

    return cast(Solver, solve)


def _is_distance(fidelity: Fidelity) -> TypeGuard[SeparableQuadratic]:
    """Whether H is a weighted square of the distance to a map, without a box."""
    return (
        isinstance(fidelity, SeparableQuadratic)
        and fidelity.is_quadratic
        and bool(fidelity.weight.any())
        and not fidelity.slope.any()
    )
