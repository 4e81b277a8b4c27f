"""The problem handed to an interior-point solver for second-order cones, an independent referee on small meshes."""

from __future__ import annotations

import numpy as np
from scipy.sparse import diags_array

from surfexp.extras import require_installed
from surfexp.operators.calculus import adjoint_gradient, gradient_matrix
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.duality_gap import Iterate, run_to_gap
from surfexp.variational.fidelity import Fidelity, Progress
from surfexp.variational.own_unit import in_own_unit
from surfexp.variational.published.vector_pair import project_to_ball
from surfexp.variational.separable_quadratic import SeparableQuadratic
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.fista_dual import require_consistent


@in_own_unit
def conic(
    fidelity: Fidelity,
    operator: SurfaceOperator,
    start: Solution | None = None,
    *,
    tolerance: float = 1e-6,
    progress: Progress | None = None,
) -> Solution:
    """Minimise TV + H by CVXPY with CLARABEL; the certificate is computed here from its primal and dual.

    Parameters
    ----------
    fidelity : SeparableQuadratic
        Of a scalar image.
    operator : SurfaceOperator
        Consistent.
    start
        Not used.
    tolerance : float
        The result counts as converged when its relative gap is at most this; the solver itself runs to 1e-10.
    progress : callable, optional

    Raises
    ------
    ImportError
        If cvxpy or clarabel is missing.
    """
    require_installed("solver conic", "cvxpy", "clarabel")
    require_consistent(operator, "conic")
    if not isinstance(fidelity, SeparableQuadratic) or len(fidelity.shape) > 1:
        raise ValueError(f"conic solves scalar quadratics with a box, not {fidelity.name} of shape {fidelity.shape}")
    iterate = _solve(fidelity, operator)
    return run_to_gap([iterate], fidelity, operator, "conic", tolerance, progress)


def _solve(fidelity: SeparableQuadratic, operator: SurfaceOperator) -> Iterate:
    import cvxpy as cp

    count = len(operator.faces)
    unknown, field = cp.Variable(operator.vertex_count), cp.Variable((count, 2))
    weighted = diags_array(np.repeat(operator.areas, 2)) @ gradient_matrix(operator)
    link = cp.vec(field, order="C") == weighted @ unknown
    linear = operator.mass * (fidelity.slope - fidelity.weight * fidelity.target)
    energy = cp.sum(cp.norm(field, 2, axis=1)) + linear @ unknown
    if fidelity.weight.any():
        roots = np.sqrt(0.5 * operator.mass * fidelity.weight)
        energy = energy + cp.sum_squares(cp.multiply(roots, unknown))
    constraints = [link]
    if not fidelity.is_quadratic:
        constraints += [unknown >= fidelity.lower, unknown <= fidelity.upper]
    problem = cp.Problem(cp.Minimize(energy), constraints)
    problem.solve(solver=cp.CLARABEL, tol_gap_abs=1e-10, tol_gap_rel=1e-10, tol_feas=1e-10)
    if unknown.value is None:
        raise ValueError(f"CLARABEL ended with status {problem.status!r} and no solution")
    dual = project_to_ball(-link.dual_value.reshape(count, 2))
    load = adjoint_gradient(operator, dual)
    iterations = int(problem.solver_stats.num_iters or 0)
    return Iterate(iterations, np.clip(unknown.value, fidelity.lower, fidelity.upper), dual, load)
