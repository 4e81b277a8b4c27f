"""Newton's method on the central path: ROF to a relative gap of 1e-10 in about ten factorisations."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.operators.calculus import adjoint_gradient, gradient, total_variation
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.duality_gap import Iterate, run_to_gap
from surfexp.variational.fidelity import Fidelity, Progress
from surfexp.variational.own_unit import in_own_unit
from surfexp.variational.separable_quadratic import SeparableQuadratic
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.chambolle_pock import chambolle_pock_iterates
from surfexp.variational.solvers.cone_newton import complementarity, curvature_blocks, face_moves, residual_fields
from surfexp.variational.solvers.fista_dual import require_consistent
from surfexp.variational.solvers.newton_system import NewtonSystem

WARM_UP = 1e-3
INSIDE = 0.99
STEP_SHARE = 0.98
SHORT_STEP = 0.2
CENTRING = 0.05
ROUNDS = 4
SAFE_CENTRING = 0.8


@in_own_unit
def newton(
    fidelity: Fidelity,
    operator: SurfaceOperator,
    start: Solution | None = None,
    *,
    tolerance: float = 1e-10,
    iteration_limit: int = 60,
    progress: Progress | None = None,
) -> Solution:
    """Minimise TV + H, H quadratic and strongly convex, by a primal-dual Newton method with several corrections a factorisation.

    Each of four rounds puts the second-order term of the moves before it into the right-hand side, which costs a solve and
    lets longer steps be taken.
    Every iterate has |p| < 1 on all faces, and after a full step satisfies mu m (phi - I) + G^T A p = 0, so its gap is the
    complementarity and falls faster than geometrically. Without `start` some primal-dual iterations come first.

    Parameters
    ----------
    fidelity : SeparableQuadratic
        Of a scalar image, strongly convex, without a box.
    operator : SurfaceOperator
        Consistent.
    start : Solution, optional
        Its values, and its dual field where that proves a relative gap below 0.002.
    tolerance : float
        Bound of the relative gap.
    iteration_limit : int
    progress : callable, optional

    References
    ----------
    Goldfarb, Yin: Second-order cone programming methods for total variation-based image restoration (2005).
    Chan, Golub, Mulet: A nonlinear primal-dual method for total variation-based image restoration (1999).
    """
    require_consistent(operator, "newton")
    if (
        not isinstance(fidelity, SeparableQuadratic)
        or not fidelity.is_quadratic
        or fidelity.strong_convexity <= 0
        or fidelity.shape != (operator.vertex_count,)
    ):
        raise ValueError(
            f"newton solves a strongly convex quadratic of {operator.vertex_count} values, not {fidelity.name} of shape "
            f"{fidelity.shape}: use primal_dual or split_bregman"
        )
    if start is None:
        warm_up = chambolle_pock_iterates(fidelity, operator, None, fidelity.step, 200)
        start = run_to_gap(warm_up, fidelity, operator, "primal_dual", WARM_UP)
        if start.relative_gap == 0.0:
            return replace(start, solver="newton")
    iterates = _iterates(fidelity, operator, start, iteration_limit)
    return run_to_gap(iterates, fidelity, operator, "newton", tolerance, progress)


def _iterates(
    fidelity: SeparableQuadratic, operator: SurfaceOperator, start: Solution, limit: int
) -> Iterator[Iterate]:
    hats, areas, values = operator.hat_gradients, operator.areas, start.values.copy()
    weight = operator.mass * fidelity.weight
    pull = operator.mass * (fidelity.weight * fidelity.target - fidelity.slope)
    system = NewtonSystem(operator, weight)
    grad = gradient(operator, values)
    nu = 0.1 * (total_variation(operator, values) + fidelity.value(values)) / areas.sum()
    slack = _central_slack(nu, grad)
    near = start.dual is not None and start.relative_gap is not None and start.relative_gap <= 2.0 * WARM_UP
    dual = INSIDE * start.dual if near and start.dual is not None else grad / slack[:, None]
    still = (np.zeros_like(slack), np.zeros_like(grad), np.zeros_like(dual))
    for iteration in range(1, limit + 1):
        nu = complementarity(areas, slack, grad, dual)
        blocks, local = curvature_blocks(hats, areas, slack, grad, dual)
        system.refactor(local)
        for centring, rounds in ((CENTRING, ROUNDS), (SAFE_CENTRING, 1)):
            moves, best, longest = still, None, 0.0
            for _ in range(rounds):
                base, rest = residual_fields(centring * nu, slack, grad, dual, moves)
                move = system.solve(pull - weight * values - adjoint_gradient(operator, dual + base))
                grad_move = gradient(operator, move)
                slack_move, dual_move, cone, ball = face_moves(slack, grad, dual, blocks, grad_move, base, rest)
                steps = min(1.0, STEP_SHARE * cone), min(1.0, STEP_SHARE * ball)
                if min(steps) < SHORT_STEP * longest:
                    break
                moves, longest = (slack_move, grad_move, dual_move), min(steps)
                best = (move, slack_move, dual_move, *steps)
            if longest >= SHORT_STEP:
                break
        assert best is not None  # noqa: S101, narrows a type
        move, slack_move, dual_move, primal_step, dual_step = best
        values = values + primal_step * move
        slack, grad = slack + primal_step * slack_move, gradient(operator, values)
        dual = dual + dual_step * dual_move
        if longest < SHORT_STEP:
            slack, dual = _central_slack(complementarity(areas, slack, grad, dual), grad), INSIDE * dual
        yield Iterate(iteration, values, dual, adjoint_gradient(operator, dual))


def _central_slack(nu: float, grad: Floats) -> Floats:
    """Return the t of the central path, t^2 - nu t = |G phi|^2 on every face."""
    return 0.5 * (nu + np.sqrt(nu * nu + 4.0 * np.einsum("fa,fa->f", grad, grad))) + np.finfo(float).tiny
