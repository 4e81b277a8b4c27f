"""Newton's method on the central path: ROF to a relative gap of 1e-10 in some twenty factorisations."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.sparse import csr_array, diags_array

from surfexp.linalg.factorisation import factorise
from surfexp.mesh.triangle_mesh import Floats
from surfexp.operators.assembly import assemble
from surfexp.operators.calculus import adjoint_gradient, gradient, total_variation
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.chambolle_pock import chambolle_pock_iterates
from surfexp.variational.cone_newton import complementarity, curvature_blocks, face_moves, residual_fields
from surfexp.variational.duality_gap import Iterate, run_to_gap
from surfexp.variational.fidelity import Fidelity, Progress
from surfexp.variational.fista_dual import require_consistent
from surfexp.variational.separable_quadratic import SeparableQuadratic
from surfexp.variational.solution import Solution

WARM_UP = 1e-3
STEP_SHARE = 0.98
SHORT_STEP = 0.2


def newton(
    fidelity: Fidelity,
    operator: SurfaceOperator,
    start: Solution | None = None,
    *,
    tolerance: float = 1e-10,
    iteration_limit: int = 60,
    progress: Progress | None = None,
) -> Solution:
    """Minimise TV + H, H quadratic and strongly convex, by a predictor-corrector primal-dual Newton method.

    Every iterate has |p| < 1 on all faces, and after a full step satisfies mu m (phi - I) + G^T A p = 0, so its gap is the
    complementarity and falls faster than geometrically. Without `start` some primal-dual iterations come first.

    Parameters
    ----------
    fidelity : SeparableQuadratic
        Of a scalar image, strongly convex, without a box.
    operator : SurfaceOperator
        Consistent.
    start : Solution, optional
        Only its values are used.
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
    iterates = _iterates(fidelity, operator, start.values.copy(), iteration_limit)
    return run_to_gap(iterates, fidelity, operator, "newton", tolerance, progress)


def _iterates(fidelity: SeparableQuadratic, operator: SurfaceOperator, values: Floats, limit: int) -> Iterator[Iterate]:
    hats, areas = operator.hat_gradients, operator.areas
    weight = operator.mass * fidelity.weight
    pull = operator.mass * (fidelity.weight * fidelity.target - fidelity.slope)
    grad = gradient(operator, values)
    nu = 0.1 * (total_variation(operator, values) + fidelity.value(values)) / areas.sum()
    slack = 0.5 * (nu + np.sqrt(nu * nu + 4.0 * np.einsum("fa,fa->f", grad, grad))) + np.finfo(float).tiny
    dual = grad / slack[:, None]
    for iteration in range(1, limit + 1):
        nu = complementarity(areas, slack, grad, dual)
        blocks, local = curvature_blocks(hats, areas, slack, grad, dual)
        system = factorise(csr_array(assemble(operator.faces, local, len(values)) + diags_array(weight)))
        still = (np.zeros_like(slack), np.zeros_like(grad), np.zeros_like(dual))
        moves, centring = still, 0.0
        for attempt in ("predictor", "corrector", "centring"):
            base, rest = residual_fields(centring * nu, slack, grad, dual, moves)
            move = system.solve(pull - weight * values - adjoint_gradient(operator, dual + base))
            grad_move = gradient(operator, move)
            slack_move, dual_move, cone, ball = face_moves(slack, grad, dual, blocks, grad_move, base, rest)
            moves = (slack_move, grad_move, dual_move)
            primal_step, dual_step = min(1.0, STEP_SHARE * cone), min(1.0, STEP_SHARE * ball)
            ahead = (slack + primal_step * slack_move, grad + primal_step * grad_move, dual + dual_step * dual_move)
            if attempt == "predictor":
                centring = float(np.clip((complementarity(areas, *ahead) / nu) ** 3, 1e-4, 1.0))
            elif min(primal_step, dual_step) >= SHORT_STEP:
                break
            else:
                moves, centring = still, 0.8
        values = values + primal_step * move
        slack, grad, dual = ahead[0], gradient(operator, values), ahead[2]
        yield Iterate(iteration, values, dual, adjoint_gradient(operator, dual))
