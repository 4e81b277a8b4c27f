"""Energy, lower bound and gap of a field and a dual field, and the protocol by which every solver runs to a gap."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.operators.calculus import adjoint_gradient, total_variation
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.fidelity import Fidelity, Progress
from surfexp.variational.solution import Solution

ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class Iterate:
    """What a solver hands over when its gap is due.

    Parameters
    ----------
    iteration : int
    values : (n,) or (n, c) float64
        In the domain of the fidelity.
    dual : (m, 2) or (m, c, 2) float64
        |p| <= 1 on every face.
    load : like `values`
        G^T A p.
    """

    iteration: int
    values: Floats
    dual: Floats
    load: Floats


@dataclass(frozen=True)
class Certificate:
    """Energy >= minimum >= lower_bound."""

    energy: float
    lower_bound: float
    relative_gap: float
    error_bound: float | None


def certify(fidelity: Fidelity, operator: SurfaceOperator, values: Floats, load: Floats) -> Certificate:
    """Return the certificate of `values` by the dual field whose load is given."""
    energy = total_variation(operator, values) + fidelity.value(values)
    lower_bound = fidelity.dual_value(load)
    scale = fidelity.gap_scale(energy, lower_bound)
    return certificate_of(energy, lower_bound, scale, fidelity.strong_convexity)


def certificate_of(energy: float, lower_bound: float, scale: float, strong_convexity: float) -> Certificate:
    """Return the certificate of an energy and a bound, without the bound where it cannot be one.

    A bound above the energy by more than 1e-9 of the scale, or a number that is none, proves nothing: the relative gap is
    then infinite. Below that the bound exceeds the energy by rounding, and the gap counts as 0.

    Parameters
    ----------
    energy, lower_bound : float
    scale : float
        What the gap is divided by.
    strong_convexity : float
        Of the energy in the mass norm; 0 gives no bound of the error.
    """
    relative_gap = (energy - lower_bound) / scale
    if not relative_gap >= -ROUNDING:
        return Certificate(energy, -float(np.inf), float(np.inf), None)
    gap = max(energy - lower_bound, 0.0)
    error_bound = float(np.sqrt(2.0 * gap / strong_convexity)) if strong_convexity > 0 else None
    return Certificate(energy, lower_bound, max(float(relative_gap), 0.0), error_bound)


def run_to_gap(
    iterates: Iterable[Iterate],
    fidelity: Fidelity,
    operator: SurfaceOperator,
    solver: str,
    tolerance: float | None,
    progress: Progress | None = None,
) -> Solution:
    """Take iterates until the relative gap is at most `tolerance`, and certify the one that is returned.

    Parameters
    ----------
    iterates : iterable of Iterate
        Ends by itself at the iteration limit.
    fidelity, operator
        The problem; gradients are those of the faces whatever the solver used.
    solver : str
        Name for captions.
    tolerance : float, optional
        Bound of the relative gap; default: that of the model.
    progress : callable, optional
        Called with the iteration and the relative gap.
    """
    rows: list[tuple[float, float, float]] = []
    small = fidelity.tolerance if tolerance is None else tolerance
    converged = False
    for iterate in iterates:
        certificate = certify(fidelity, operator, iterate.values, iterate.load)
        rows.append((iterate.iteration, certificate.energy, certificate.relative_gap))
        if progress is not None:
            progress(iterate.iteration, certificate.relative_gap)
        if certificate.relative_gap <= small:
            converged = True
            break
    if not rows:
        raise ValueError("iteration_limit is 0, must be at least 1")
    iterations, energies, gaps = (np.array(column, dtype=np.float64) for column in zip(*rows, strict=True))
    solution = Solution(
        values=iterate.values.copy(),
        energy=certificate.energy,
        dual=iterate.dual.copy(),
        iterations=int(iterations[-1]),
        converged=converged,
        reason="gap below tolerance" if converged else "iteration limit",
        history={"iteration": iterations, "energy": energies, "gap": gaps},
        model=fidelity.name,
        solver=solver,
    )
    return with_certificate(solution, certificate)


def recertify(solution: Solution, fidelity: Fidelity, operator: SurfaceOperator) -> Solution:
    """Return `solution` with its certificate computed afresh from its values and its dual field."""
    if solution.dual is None:
        raise ValueError(f"the solution of {solution.solver!r} has no dual field, a certificate needs one")
    return with_certificate(
        solution, certify(fidelity, operator, solution.values, adjoint_gradient(operator, solution.dual))
    )


def with_certificate(solution: Solution, certificate: Certificate) -> Solution:
    """Return `solution` with the numbers of `certificate` in its fields and metrics."""
    bounded = bool(np.isfinite(certificate.lower_bound))
    metrics = {"energy": certificate.energy, "iterations": float(solution.iterations)}
    if bounded:
        gap = max(certificate.energy - certificate.lower_bound, 0.0)
        metrics |= {"lower_bound": certificate.lower_bound, "gap": gap, "relative_gap": certificate.relative_gap}
    if bounded and certificate.error_bound is not None:
        metrics["error_bound"] = certificate.error_bound
    return replace(
        solution,
        energy=certificate.energy,
        lower_bound=certificate.lower_bound if bounded else None,
        relative_gap=certificate.relative_gap if bounded else None,
        error_bound=certificate.error_bound if bounded else None,
        metrics=solution.metrics | metrics,
    )
