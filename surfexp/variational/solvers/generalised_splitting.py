"""Split Bregman iterations for total generalised variation, with one factorisation."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.sparse import diags_array

from surfexp.contract.arrays import Floats
from surfexp.linalg.ldlt import ldlt
from surfexp.operators.calculus import gradient
from surfexp.variational.fidelity import Progress
from surfexp.variational.generalised_solution import (
    GeneralisedIterate,
    GeneralisedSolution,
    generalised_in_own_unit,
    run_to_gap,
)
from surfexp.variational.generalised_variation import PARTS, GeneralisedVariation, cut, shortened

STEPS_PER_CHECK = 10
# of cutting and balancing before a check: two give nearly what three give
ROUNDS = 2


@generalised_in_own_unit
def generalised_splitting(
    problem: GeneralisedVariation,
    *,
    tolerance: float = 1e-4,
    iteration_limit: int = 20000,
    penalty: float | None = None,
    relaxation: float = 1.8,
    progress: Progress | None = None,
) -> GeneralisedSolution:
    """Minimise total generalised variation and a quadratic by split Bregman iterations, over-relaxed.

    u and w are found together, by one factorisation of a matrix of n + 2 e rows; G u - w and D w are shortened face by
    face.

    Parameters
    ----------
    problem : GeneralisedVariation
    tolerance : float
        Bound of the relative gap.
    iteration_limit : int
    penalty : float, optional
        Of G u - w, in (unit of length) / (unit of the image); that of D w is h^2 times this. Default: 9 over the mean
        length of the gradient of the image.
    relaxation : float
        In (0, 2).
    progress : callable, optional
        Receives the iteration and the relative gap.

    Raises
    ------
    ValueError
        If the relaxation is outside its interval.
    """
    if not 0 < relaxation < 2:
        raise ValueError(f"relaxation is {relaxation}, must lie in (0, 2); 1.8 is usual")
    iterates = _iterates(problem, _penalty(problem) if penalty is None else penalty, relaxation, iteration_limit)
    return run_to_gap(iterates, problem, "generalised_splitting", tolerance, progress)


def _penalty(problem: GeneralisedVariation) -> float:
    """What is shortened, by 1 / penalty, is then a ninth of a slope: the least worst case of 3, 9 and 18 over it."""
    operator = problem.operator
    slopes = np.linalg.norm(gradient(operator, problem.fidelity.target), axis=1)
    mean = float(operator.areas @ slopes / operator.areas.sum())
    # a constant has no gradient, and its minimiser is found by any penalty
    return 9.0 / mean if mean > 0.0 else 10.0 * problem.fidelity.strong_convexity * operator.edge_length**2


def _iterates(
    problem: GeneralisedVariation, penalty: float, relaxation: float, limit: int
) -> Iterator[GeneralisedIterate]:
    fidelity, operator, forms = problem.fidelity, problem.operator, problem.forms
    penalties = penalty, penalty * (operator.edge_length / problem.ratio) ** 2
    by_row = np.tile(np.repeat(penalties, PARTS), len(operator.faces))
    adjoint = problem.adjoint @ diags_array(by_row)
    weight, pull = np.zeros(forms.shape[1]), np.zeros(forms.shape[1])
    problem.values(weight)[:] = operator.mass * fidelity.weight
    problem.values(pull)[:] = operator.mass * (fidelity.weight * fidelity.target - fidelity.slope)
    system = ldlt(diags_array(weight) + adjoint @ forms)

    def shorter(dual: Floats) -> Floats:
        """Cut a balanced field to length 1 and balance it again, with nearly the load that it had on u."""
        for _ in range(ROUNDS):
            change = cut(dual) - dual
            dual = dual + change - by_row * (forms @ system.solve(problem.adjoint @ change))
        return dual

    field, offset = np.zeros(forms.shape[0]), np.zeros(forms.shape[0])
    for iteration in range(1, limit + 1):
        unknowns = system.solve(pull + adjoint @ (field - offset))
        found = forms @ unknowns
        if iteration % STEPS_PER_CHECK == 0 or iteration == limit:
            # the equation of w says that this field balances
            yield GeneralisedIterate(iteration, unknowns, shorter(by_row * (found - field + offset)))
        mixed = relaxation * found + (1.0 - relaxation) * field + offset
        field = shortened(mixed, 1.0 / penalties[0], 1.0 / penalties[1])
        offset = mixed - field
