"""The primal-dual method of Chambolle and Pock for total generalised variation, a step for every row and column."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from surfexp.variational.fidelity import Progress
from surfexp.variational.generalised_solution import (
    GeneralisedIterate,
    GeneralisedSolution,
    generalised_in_own_unit,
    run_to_gap,
)
from surfexp.variational.generalised_variation import PARTS, GeneralisedVariation, cut

STEPS_PER_CHECK = 50


@generalised_in_own_unit
def generalised_primal_dual(
    problem: GeneralisedVariation,
    *,
    tolerance: float = 1e-3,
    iteration_limit: int = 100000,
    step: float | None = None,
    progress: Progress | None = None,
) -> GeneralisedSolution:
    """Minimise total generalised variation and a quadratic by primal-dual steps; only certificates factorise.

    Parameters
    ----------
    problem : GeneralisedVariation
    tolerance : float
        Bound of the relative gap.
    iteration_limit : int
    step : float, optional
        Ratio of primal to dual steps, in (unit of the image) / (unit of length). Default: a hundredth of the spread of
        the image over h.
    progress : callable, optional
        Receives the iteration and the relative gap.

    References
    ----------
    Pock, Chambolle: Diagonal preconditioning for first order primal-dual algorithms in convex optimization (2011).
    """
    spread = float(problem.fidelity.target.std()) or 1.0
    chosen = 0.01 * spread / problem.operator.edge_length if step is None else step
    iterates = _iterates(problem, chosen, iteration_limit)
    return run_to_gap(iterates, problem, "generalised_primal_dual", tolerance, progress)


def _iterates(problem: GeneralisedVariation, step: float, limit: int) -> Iterator[GeneralisedIterate]:
    fidelity, forms, adjoint, count = problem.fidelity, problem.forms, problem.adjoint, problem.operator.vertex_count
    primal_step = step / abs(adjoint).sum(axis=1)
    rows = abs(forms).sum(axis=1).reshape(-1, 6)
    parts = np.stack([rows[:, :2].max(axis=1), rows[:, 2:].max(axis=1)], axis=1)
    dual_step = 1.0 / (step * np.repeat(parts, PARTS, axis=1).ravel())
    pull = primal_step[:count] * problem.operator.mass
    unknowns, dual = np.zeros(forms.shape[1]), np.zeros(forms.shape[0])
    unknowns[:count] = fidelity.initial()
    ahead = unknowns
    for iteration in range(1, limit + 1):
        dual = cut(dual + dual_step * (forms @ ahead))
        moved = unknowns - primal_step * (adjoint @ dual)
        moved[:count] = (moved[:count] + pull * (fidelity.weight * fidelity.target - fidelity.slope)) / (
            1.0 + pull * fidelity.weight
        )
        ahead, unknowns = 2.0 * moved - unknowns, moved
        if iteration % STEPS_PER_CHECK == 0 or iteration == limit:
            yield GeneralisedIterate(iteration, unknowns, dual)
