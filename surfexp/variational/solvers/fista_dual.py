"""Accelerated projected gradients on the dual problem, restarted when the momentum points backwards."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from surfexp.operators.calculus import adjoint_gradient
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.duality_gap import Iterate, run_to_gap
from surfexp.variational.fidelity import Fidelity, Progress
from surfexp.variational.own_unit import in_own_unit
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.chambolle_dual import require_strong_convexity
from surfexp.variational.solvers.chambolle_pock import CHECK_INTERVAL, starting_fields
from surfexp.variational.solvers.face_sweeps import face_steps, fista_step


@in_own_unit
def fista_dual(
    fidelity: Fidelity,
    operator: SurfaceOperator,
    start: Solution | None = None,
    *,
    tolerance: float = 1e-4,
    iteration_limit: int = 20000,
    progress: Progress | None = None,
) -> Solution:
    """Minimise TV + H, H strongly convex, by FISTA on the dual problem with adaptive restart.

    Parameters
    ----------
    fidelity : Fidelity
        Strongly convex.
    operator : SurfaceOperator
        Consistent.
    start : Solution, optional
        Its dual field is begun with.
    tolerance : float
        Bound of the relative gap.
    iteration_limit : int
    progress : callable, optional

    References
    ----------
    Beck, Teboulle: Fast gradient-based algorithms for constrained total variation image denoising (2009).
    O'Donoghue, Candes: Adaptive restart for accelerated gradient schemes (2015).
    """
    require_consistent(operator, "fista_dual")
    require_strong_convexity(fidelity, "fista_dual")
    iterates = _iterates(fidelity, operator, start, iteration_limit)
    return run_to_gap(iterates, fidelity, operator, "fista_dual", tolerance, progress)


def require_consistent(operator: SurfaceOperator, solver: str) -> None:
    """Refuse an operator whose divergence is not the adjoint of its gradient.

    Raises
    ------
    ValueError
        If the operator is not consistent.
    """
    if operator.averaged_gradient is not None:
        raise ValueError(
            f"{solver} descends an energy and {operator.name} has none: use operator fem, or solver split_bregman, "
            "chambolle_dual or primal_dual"
        )


def _iterates(fidelity: Fidelity, operator: SurfaceOperator, start: Solution | None, limit: int) -> Iterator[Iterate]:
    values, dual = starting_fields(fidelity, operator, start)
    steps = face_steps(operator.hat_gradients)
    ahead, load = dual.copy(), adjoint_gradient(operator, dual)
    views = (dual.reshape(len(dual), -1, 2), ahead.reshape(len(dual), -1, 2), load.reshape(len(load), -1))
    faces = (operator.faces, operator.hat_gradients, operator.areas)
    age = 1.0
    for iteration in range(1, limit + 1):
        minimiser = fidelity.primal_from_dual(load)
        assert minimiser is not None  # noqa: S101, narrows a type
        older = 0.5 * (1.0 + np.sqrt(1.0 + 4.0 * age * age))
        momentum, age = (age - 1.0) / older, older
        channels = minimiser.reshape(len(values), -1)
        if fista_step(*faces, steps, fidelity.strong_convexity, momentum, channels, *views) > 0.0:
            age = 1.0
        if iteration % CHECK_INTERVAL == 0 or iteration == limit:
            own = adjoint_gradient(operator, dual)
            minimiser = fidelity.primal_from_dual(own)
            assert minimiser is not None  # noqa: S101, narrows a type
            yield Iterate(iteration, minimiser, dual, own)
