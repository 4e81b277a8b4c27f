"""The matrices of total generalised variation, which do not depend on the image: problems on one mesh share them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import block_array, csr_array, diags_array

from surfexp.contract.arrays import Floats
from surfexp.linalg.ldlt import LDLT, ldlt
from surfexp.operators.calculus import gradient_matrix
from surfexp.operators.crouzeix_raviart import TangentFields, tangent_fields
from surfexp.operators.surface_operator import SurfaceOperator


@dataclass(frozen=True, eq=False)
class GeneralisedForms:
    """What a field u on n vertices and a slope w on e edges are charged for, on each of m faces.

    Parameters
    ----------
    operator : SurfaceOperator
        Consistent.
    ratio : float
        Unit of length.
    """

    operator: SurfaceOperator
    ratio: float

    @cached_property
    def fields(self) -> TangentFields:
        """The space of w."""
        return tangent_fields(self.operator)

    @cached_property
    def forms(self) -> csr_array:
        """(6 m, n + 2 e) matrix of u and w in one array: on each face two rows of G u - w, then four of ratio D w."""
        count, fields = len(self.operator.faces), self.fields
        empty = csr_array((4 * count, self.operator.vertex_count))
        blocks = [[gradient_matrix(self.operator), -fields.averages], [empty, self.ratio * fields.derivative]]
        rows = [np.arange(2 * count).reshape(-1, 2), 2 * count + np.arange(4 * count).reshape(-1, 4)]
        return csr_array(csr_array(block_array(blocks))[np.concatenate(rows, axis=1).ravel()])

    @cached_property
    def adjoint(self) -> csr_array:
        """(n + 2 e, 6 m) matrix of the load of a field, the adjoint of `forms` by area."""
        return csr_array(self.forms.T @ diags_array(np.repeat(self.operator.areas, 6)))

    def imbalance(self, dual: Floats) -> float:
        """Largest load of w by a (6 m,) field over the largest force on an edge: 0 for what proves a lower bound."""
        slope_loads, sizes = self._slope_loads
        return float(np.abs(slope_loads @ dual).max() / max((sizes @ np.abs(dual)).max(), np.finfo(float).tiny))

    def balanced(self, dual: Floats) -> Floats:
        """Return the (6 m,) field nearest to this one that loads no w."""
        move = self._balance.solve(self._slope_loads[0] @ dual)
        return np.asarray(dual - self._slope_forms @ move)

    @cached_property
    def _slope_loads(self) -> tuple[csr_array, csr_array]:
        """The rows of w of `adjoint`, and their absolute values."""
        rows = csr_array(self.adjoint[self.operator.vertex_count :])
        return rows, abs(rows)

    @cached_property
    def _slope_forms(self) -> csr_array:
        return csr_array(self.forms[:, self.operator.vertex_count :])

    @cached_property
    def _balance(self) -> LDLT:
        return ldlt(self._slope_loads[0] @ self._slope_forms)
