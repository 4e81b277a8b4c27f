"""Chambolle's dual iteration (2.26), with a step of its own on every face."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.duality_gap import Iterate, run_to_gap
from surfexp.variational.fidelity import Fidelity, Progress
from surfexp.variational.own_unit import in_own_unit
from surfexp.variational.published.chambolle import published_chambolle
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.chambolle_pock import CHECK_INTERVAL, starting_fields
from surfexp.variational.solvers.face_sweeps import chambolle_step, face_steps


@in_own_unit
def chambolle_dual(
    fidelity: Fidelity,
    operator: SurfaceOperator,
    start: Solution | None = None,
    *,
    tolerance: float | None = None,
    iteration_limit: int = 20000,
    progress: Progress | None = None,
) -> Solution:
    """Minimise TV + H, H strongly convex, by the semi-implicit dual iteration.

    With a vertex-averaged operator the published iteration runs instead (`published_chambolle`).

    Parameters
    ----------
    fidelity : Fidelity
        Strongly convex.
    operator : SurfaceOperator
    start : Solution, optional
        Its dual field is begun with.
    tolerance : float, optional
        Bound of the relative gap; default: that of the model.
    iteration_limit : int
    progress : callable, optional

    References
    ----------
    Chambolle: An algorithm for total variation minimization and applications (2004).
    """
    if operator.averaged_gradient is not None:
        return published_chambolle(
            fidelity, operator, start, tolerance=tolerance, iteration_limit=iteration_limit, progress=progress
        )
    require_strong_convexity(fidelity, "chambolle_dual")
    iterates = _iterates(fidelity, operator, start, iteration_limit)
    return run_to_gap(iterates, fidelity, operator, "chambolle_dual", tolerance, progress)


def require_strong_convexity(fidelity: Fidelity, solver: str) -> None:
    """Refuse a fidelity for which the dual problem is not smooth.

    Raises
    ------
    ValueError
        If mu is 0.
    """
    if fidelity.strong_convexity <= 0:
        raise ValueError(
            f"{solver} needs a strongly convex fidelity, {fidelity.name} has mu = 0: use primal_dual or split_bregman"
        )


def _iterates(fidelity: Fidelity, operator: SurfaceOperator, start: Solution | None, limit: int) -> Iterator[Iterate]:
    values, dual = starting_fields(fidelity, operator, start)
    steps = face_steps(operator.hat_gradients)
    load = np.zeros(values.shape)
    views = (dual.reshape(len(dual), -1, 2), load.reshape(len(load), -1))
    faces = (operator.faces, operator.hat_gradients, operator.areas)
    for iteration in range(1, limit + 1):
        chambolle_step(*faces, steps, fidelity.strong_convexity, values.reshape(len(values), -1), *views)
        minimiser = fidelity.primal_from_dual(load)
        assert minimiser is not None  # noqa: S101, narrows a type
        values = minimiser
        if iteration % CHECK_INTERVAL == 0 or iteration == limit:
            yield Iterate(iteration, values, dual, load)
