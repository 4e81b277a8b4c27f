"""Split Bregman iterations as published: (2.18) and (2.21), with (2.34)-(2.40) for the linear systems."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Literal

import numpy as np
from scipy.sparse import csr_array, diags_array
from scipy.sparse.linalg import cg

from surfexp.contract.arrays import Floats
from surfexp.linalg.factorisation import factorise
from surfexp.linalg.gauss_seidel import gauss_seidel
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.calculus import adjoint_gradient
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.duality_gap import Iterate, run_to_gap
from surfexp.variational.fidelity import Fidelity, Progress
from surfexp.variational.published.averaged_iterations import require_scalar
from surfexp.variational.published.consistent_audit import run_and_audit
from surfexp.variational.published.vector_pair import VectorPair, shrink
from surfexp.variational.separable_quadratic import SeparableQuadratic
from surfexp.variational.solution import Solution

Inner = Literal["gauss_seidel", "cg", "direct"]
Laplacian = Literal["fem", "(1.19)"]
LinearSolve = Callable[[Floats, Floats], Floats]


def published_split_bregman(
    fidelity: Fidelity,
    operator: SurfaceOperator,
    start: Solution | None = None,
    *,
    tolerance: float | None = None,
    iteration_limit: int = 5000,
    penalty: float | None = None,
    inner: Inner = "gauss_seidel",
    sweeps: int = 1,
    laplacian: Laplacian = "fem",
    progress: Progress | None = None,
) -> Solution:
    """Run the published iteration; where the operator is vertex-averaged, with W and FEM matrices mixed as published.

    ROF solves (mu B + lambda Q) phi = B (mu I + lambda div(b - V)). Convex Chan-Vese solves the singular system
    Q phi = -B (mu r / lambda + div(V - b)) and clamps phi to [0, 1] afterwards, which is not the constrained minimiser.

    Parameters
    ----------
    fidelity : SeparableQuadratic
        ROF or a convex Chan-Vese step.
    operator : SurfaceOperator
    start : Solution, optional
        Only its values are used: V = b = 0 as published.
    tolerance : float
        Bound of the relative gap, or of the relative change where the operator is not consistent.
    iteration_limit : int
    penalty : float, optional
        lambda, on which the result of the inconsistent pair depends. Default: 0.1 mu h^2 for ROF, 0.2 h^2 mean|mu r| for
        Chan-Vese, where that result was seen to be best.
    inner : {"gauss_seidel", "cg", "direct"}
        How the linear system is solved; the published result depends on it.
    sweeps : int
        Gauss-Seidel sweeps, or conjugate gradient iterations, an iteration.
    laplacian : {"fem", "(1.19)"}
        B is the consistent mass K of (2.37), or the ring area / 3 of (1.19).
    progress : callable, optional
    """
    if not isinstance(fidelity, SeparableQuadratic) or np.ptp(fidelity.weight) > 0:
        raise ValueError(f"the published split Bregman iteration solves ROF and convex Chan-Vese, not {fidelity.name}")
    require_scalar(fidelity, operator)
    if penalty is None:
        scale = max(0.1 * fidelity.strong_convexity, 0.2 * float(np.abs(fidelity.slope).mean()))
        penalty = scale * operator.edge_length**2
    mass = mass_matrix(operator) if laplacian == "fem" else csr_array(diags_array(operator.mass))
    mu = fidelity.strong_convexity
    solve = _linear_solve(csr_array(mu * mass + penalty * stiffness(operator)), operator.mass, inner, sweeps)
    states = _states(fidelity, operator, start, penalty, mass, solve, iteration_limit)
    name = "published_split_bregman"
    if operator.consistent:
        iterates = (Iterate(k, phi, penalty * b, adjoint_gradient(operator, penalty * b)) for k, phi, b in states)
        return run_to_gap(iterates, fidelity, operator, name, tolerance, progress)
    pairs = ((k, phi) for k, phi, _ in states)
    return run_and_audit(pairs, fidelity, operator, name, tolerance, progress)


def _states(
    fidelity: SeparableQuadratic,
    operator: SurfaceOperator,
    start: Solution | None,
    penalty: float,
    mass: csr_array,
    solve: LinearSolve,
    limit: int,
) -> Iterator[tuple[int, Floats, Floats]]:
    pair = VectorPair(operator)
    values = fidelity.initial() if start is None else start.values
    field = multiplier = np.zeros(pair.field_shape)
    constant = mass @ (fidelity.weight * fidelity.target - fidelity.slope)
    for iteration in range(1, limit + 1):
        pull = (
            adjoint_gradient(operator, field - multiplier)
            if operator.consistent
            else mass @ pair.divergence(multiplier - field)
        )
        values = solve(constant + penalty * pull, values)
        values = np.clip(values, fidelity.lower, fidelity.upper)
        ahead = pair.gradient(values) + multiplier
        field = shrink(ahead, 1.0 / penalty)
        multiplier = ahead - field
        yield iteration, values, multiplier


def _linear_solve(matrix: csr_array, weights: Floats, inner: Inner, sweeps: int) -> LinearSolve:
    """Return x(b, x0); a singular matrix is solved up to the mean of x0, and its right-hand side made compatible."""
    if inner == "gauss_seidel":
        return lambda load, start: gauss_seidel(matrix, load, start, sweeps)
    if inner == "cg":
        return lambda load, start: cg(matrix, load, x0=start, rtol=0.0, maxiter=sweeps)[0]
    if inner != "direct":
        raise ValueError(f"inner is {inner!r}, must be one of 'gauss_seidel', 'cg', 'direct'")
    diagonal = matrix.diagonal().mean()
    singular = np.abs(matrix.sum(axis=0)).max() <= 1e-9 * diagonal
    if not singular:
        system = factorise(matrix)
        return lambda load, start: system.solve(load)
    regularised = factorise(matrix + diags_array(np.full(len(weights), 1e-9 * diagonal)))

    def solve(load: Floats, start: Floats) -> Floats:
        solution = regularised.solve(load - load.sum() * weights / weights.sum())
        return solution + weights @ (start - solution) / weights.sum()

    return solve
