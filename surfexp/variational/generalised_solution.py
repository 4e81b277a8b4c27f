"""What the solvers of total generalised variation return, and the protocol by which they run to a gap."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import wraps
from typing import Any, TypeVar, cast

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.variational.duality_gap import with_certificate
from surfexp.variational.fidelity import Progress
from surfexp.variational.generalised_variation import GeneralisedVariation
from surfexp.variational.own_unit import WITH_UNIT, normalised_fidelity, own_unit, restored_solution
from surfexp.variational.solution import Solution

Solver = TypeVar("Solver", bound=Callable[..., "GeneralisedSolution"])


@dataclass(frozen=True, eq=False)
class GeneralisedIterate:
    """What a solver hands over when its gap is due.

    Parameters
    ----------
    iteration : int
    unknowns : (n + 2 e,) float64
        u and w.
    dual : (6 m,) float64
        Need not be feasible.
    """

    iteration: int
    unknowns: Floats
    dual: Floats


@dataclass(frozen=True, eq=False)
class GeneralisedSolution:
    """A certified minimiser.

    Parameters
    ----------
    solution : Solution
        Values u; its dual (m, 3, 2) has p in the first row of a face and q / ratio in the others, balanced and not
        longer than 1.
    slopes : (e, 2) float64
        w along and across each edge.
    """

    solution: Solution
    slopes: Floats


def run_to_gap(
    iterates: Iterable[GeneralisedIterate],
    problem: GeneralisedVariation,
    solver: str,
    tolerance: float,
    progress: Progress | None = None,
) -> GeneralisedSolution:
    """Take iterates until the relative gap is at most `tolerance`, and certify the one that is returned."""
    rows: list[tuple[float, float, float]] = []
    for iterate in iterates:
        dual = problem.feasible(iterate.dual)
        certificate = problem.certify(iterate.unknowns, dual)
        rows.append((iterate.iteration, certificate.energy, certificate.relative_gap))
        if progress is not None:
            progress(iterate.iteration, certificate.relative_gap)
        if certificate.relative_gap <= tolerance:
            break
    if not rows:
        raise ValueError("iteration_limit is 0, must be at least 1")
    iterations, energies, gaps = (np.array(column, dtype=np.float64) for column in zip(*rows, strict=True))
    converged = certificate.relative_gap <= tolerance
    solution = Solution(
        values=problem.values(iterate.unknowns).copy(),
        energy=certificate.energy,
        dual=dual.reshape(-1, 3, 2),
        iterations=iterate.iteration,
        converged=bool(converged),
        reason="gap below tolerance" if converged else "iteration limit",
        history={"iteration": iterations, "energy": energies, "gap": gaps},
        model="TGV",
        solver=solver,
    )
    slopes = iterate.unknowns[problem.operator.vertex_count :].reshape(-1, 2).copy()
    return GeneralisedSolution(with_certificate(solution, certificate), slopes)


def generalised_in_own_unit(solver: Solver) -> Solver:
    """Let a solver work on the normalised map; a step or a penalty given in the unit of the map leaves it as it is."""

    @wraps(solver)
    def solve(problem: GeneralisedVariation, **options: Any) -> GeneralisedSolution:
        if any(options.get(name) is not None for name in WITH_UNIT):
            return solver(problem, **options)
        own = own_unit(problem.fidelity.target)
        found = solver(problem.with_fidelity(normalised_fidelity(problem.fidelity, own)), **options)
        return GeneralisedSolution(restored_solution(found.solution, own), own.unit * found.slopes)

    return cast(Solver, solve)
