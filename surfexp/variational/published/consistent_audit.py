"""Run a scheme that has no gap of its own, then measure its result under the consistent energy."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.operators.calculus import adjoint_gradient
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.duality_gap import certify, run_to_gap, with_certificate
from surfexp.variational.fidelity import Fidelity, Progress
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.chambolle_pock import chambolle_pock_iterates

AUDIT_TOLERANCE = 1e-5
AUDIT_LIMIT = 3000
NOTE = (
    "The published gradient and divergence are not adjoint, so this iteration has no energy gap of its own; the gap given "
    "is that of its result under the face-based total variation, with the lower bound of a consistent solve."
)


SMALL_CHANGE = 1e-4


def run_and_audit(
    states: Iterable[tuple[int, Floats]],
    fidelity: Fidelity,
    operator: SurfaceOperator,
    solver: str,
    tolerance: float | None,
    progress: Progress | None = None,
) -> Solution:
    """Take iterates until their relative change is at most `tolerance`, then audit the last.

    Parameters
    ----------
    states : iterable of (iteration, values)
        Ends by itself at the iteration limit.
    fidelity, operator, solver, progress
        As in `run_to_gap`; progress is given the relative change.
    tolerance : float, optional
        Default 1e-4.
        Bound of |phi_k - phi_(k-1)| / |phi_k| in the mass norm.
    """
    previous = np.zeros(fidelity.shape)
    rows: list[tuple[float, float]] = []
    converged = False
    for iteration, values in states:
        length = np.sqrt(operator.mass @ values**2)
        change = float(np.sqrt(operator.mass @ (values - previous) ** 2) / max(length, np.finfo(float).tiny))
        rows.append((iteration, change))
        if progress is not None:
            progress(iteration, change)
        previous = values
        if change <= (SMALL_CHANGE if tolerance is None else tolerance):
            converged = True
            break
    if not rows:
        raise ValueError("iteration_limit is 0, must be at least 1")
    iterations, changes = (np.array(column, dtype=np.float64) for column in zip(*rows, strict=True))
    solution = Solution(
        values=previous.copy(),
        energy=np.inf,
        iterations=int(iterations[-1]),
        converged=converged,
        reason="relative change below tolerance" if converged else "iteration limit",
        history={"iteration": iterations, "change": changes},
        model=fidelity.name,
        solver=solver,
    )
    return audit(solution, fidelity, operator)


def audit(solution: Solution, fidelity: Fidelity, operator: SurfaceOperator) -> Solution:
    """Return `solution` with its energy under the face-based TV and the lower bound of a consistent solve."""
    consistent = replace(operator, averaged_gradient=None, consistent=True)
    iterates = chambolle_pock_iterates(fidelity, consistent, None, fidelity.step, AUDIT_LIMIT)
    reference = run_to_gap(iterates, fidelity, consistent, "audit", AUDIT_TOLERANCE)
    assert reference.dual is not None  # noqa: S101, narrows a type
    certificate = certify(fidelity, consistent, solution.values, adjoint_gradient(consistent, reference.dual))
    audited = replace(solution, dual=reference.dual, notes=(*solution.notes, NOTE))
    return with_certificate(audited, certificate)
