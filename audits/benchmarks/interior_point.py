"""ROF as a second-order cone problem, stated in CVXPY once and solved by CLARABEL at a tolerance of one's choice."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.sparse import diags_array

from surfexp.operators.calculus import adjoint_gradient, gradient_matrix
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.duality_gap import certify
from surfexp.variational.published.vector_pair import project_to_ball
from surfexp.variational.separable_quadratic import SeparableQuadratic


class Conic:
    """The rival at its best: what CVXPY does to the problem, a tenth of the whole, is done before the clock starts.

    Parameters
    ----------
    problem : cvxpy.Problem
    """

    def __init__(self, problem: Any) -> None:
        import cvxpy as cp

        self._problem = problem
        self._data, self._chain, self._inverse = problem.get_problem_data(cp.CLARABEL, solver_opts={})

    def solve(self, tolerance: float) -> Any:
        """Return what CLARABEL gives; this is what is timed."""
        options = dict.fromkeys(("tol_gap_abs", "tol_gap_rel", "tol_feas"), tolerance)
        return self._chain.solve_via_data(self._problem, self._data, solver_opts=options)

    def unpack(self, found: Any) -> None:
        """Give the variables and constraints of the problem the values of a result of `solve`."""
        self._problem.unpack_results(found, self._chain, self._inverse)


class InteriorPoint(Conic):
    """ROF.

    Parameters
    ----------
    fidelity : SeparableQuadratic
        ROF of a scalar image.
    operator : SurfaceOperator
    """

    def __init__(self, fidelity: SeparableQuadratic, operator: SurfaceOperator) -> None:
        self._fidelity, self._operator = fidelity, operator
        import cvxpy as cp

        gradient = diags_array(np.repeat(operator.areas, 2)) @ gradient_matrix(operator)
        self._unknown, field = cp.Variable(operator.vertex_count), cp.Variable((len(operator.faces), 2))
        self._link = cp.vec(field, order="C") == gradient @ self._unknown
        roots = np.sqrt(0.5 * operator.mass * fidelity.weight)
        energy = cp.sum(cp.norm(field, 2, axis=1)) + cp.sum_squares(
            cp.multiply(roots, self._unknown) - roots * fidelity.target
        )
        super().__init__(cp.Problem(cp.Minimize(energy), [self._link]))

    def relative_gap(self, found: Any) -> float:
        """Return the relative gap of a result of `solve`, certified as ours is."""
        self.unpack(found)
        dual = project_to_ball(-self._link.dual_value.reshape(len(self._operator.faces), 2))
        load = adjoint_gradient(self._operator, dual)
        return float(certify(self._fidelity, self._operator, self._unknown.value, load).relative_gap)
