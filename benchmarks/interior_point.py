"""ROF as a second-order cone problem, for CVXPY with CLARABEL at a tolerance of one's choice."""

from __future__ import annotations

import numpy as np
from scipy.sparse import diags_array

from surfexp.operators.calculus import adjoint_gradient, gradient_matrix
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.duality_gap import certify
from surfexp.variational.separable_quadratic import SeparableQuadratic
from surfexp.variational.vector_pair import project_to_ball


class InteriorPoint:
    """The rival; each solve states the problem afresh, as a user would.

    Parameters
    ----------
    fidelity : SeparableQuadratic
        ROF of a scalar image.
    operator : SurfaceOperator
    """

    def __init__(self, fidelity: SeparableQuadratic, operator: SurfaceOperator) -> None:
        self._fidelity, self._operator = fidelity, operator
        self._gradient = diags_array(np.repeat(operator.areas, 2)) @ gradient_matrix(operator)

    def solve(self, tolerance: float) -> tuple[float, float]:
        """Return the relative gap, certified as ours is, and the seconds that CLARABEL says it took."""
        import cvxpy as cp

        fidelity, operator = self._fidelity, self._operator
        count = len(operator.faces)
        unknown, field = cp.Variable(operator.vertex_count), cp.Variable((count, 2))
        link = cp.vec(field, order="C") == self._gradient @ unknown
        roots = np.sqrt(0.5 * operator.mass * fidelity.weight)
        energy = cp.sum(cp.norm(field, 2, axis=1)) + cp.sum_squares(
            cp.multiply(roots, unknown) - roots * fidelity.target
        )
        problem = cp.Problem(cp.Minimize(energy), [link])
        problem.solve(solver=cp.CLARABEL, tol_gap_abs=tolerance, tol_gap_rel=tolerance, tol_feas=tolerance)
        dual = project_to_ball(-link.dual_value.reshape(count, 2))
        certificate = certify(fidelity, operator, unknown.value, adjoint_gradient(operator, dual))
        return certificate.relative_gap, float(problem.solver_stats.solve_time)
