"""The last convex problem of a segmentation, and the scales on which its gap can be read."""

from __future__ import annotations

from functools import partial

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.operators.calculus import total_variation
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.fidelity import Method
from surfexp.variational.separable_quadratic import SeparableQuadratic
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.primal_dual import primal_dual


class Recorded:
    """A method that keeps the problem it was given last.

    Parameters
    ----------
    method : callable
        A solver of convex problems.
    """

    def __init__(self, method: Method) -> None:
        self._method = method
        self.problem: SeparableQuadratic | None = None

    def __call__(
        self, fidelity: SeparableQuadratic, operator: SurfaceOperator, start: Solution | None = None
    ) -> Solution:
        """Solve, and remember the problem."""
        self.problem = fidelity
        return self._method(fidelity, operator, start)


class Excess:
    """Energy of fields above the least possible one, for one data term mu r on a surface.

    Parameters
    ----------
    problem : SeparableQuadratic
        Convex Chan-Vese with its c1, c2.
    operator : SurfaceOperator
        Of linear elements.
    """

    def __init__(self, problem: SeparableQuadratic, operator: SurfaceOperator) -> None:
        self._problem, self._operator = problem, operator
        bound = partial(primal_dual, tolerance=1e-6)(problem, operator).lower_bound
        assert bound is not None
        self._bound = bound

    def of(self, values: Floats) -> float:
        """Return the excess over the integral of |mu r|, which does not vanish where the energy does."""
        return self._absolute(values) / float(self._problem.mass @ np.abs(self._problem.slope))

    def scales(self, values: Floats) -> str:
        """Return the excess on the scales a reader may have in mind."""
        excess, full = self._absolute(values), float(self._problem.mass @ self._problem.slope)
        spread = min(0.0, full) - self._bound
        return (
            f"{self.of(values):.1e} of the integral of |mu r|, {excess / abs(self._bound):.1e} of the least energy, "
            f"{excess / max(spread, 1e-300):.1e} of the spread from the empty or full field to the least energy"
        )

    def _absolute(self, values: Floats) -> float:
        energy = total_variation(self._operator, values) + self._problem.value(values)
        return float(energy - self._bound)
