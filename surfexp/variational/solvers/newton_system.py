"""The linear systems of Newton's method on a surface: one elimination order for many matrices of a pattern."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from surfexp.contract.arrays import Floats
from surfexp.linalg.ldlt import SMALLEST_PIVOT
from surfexp.linalg.ldlt_numeric import eliminate
from surfexp.linalg.ldlt_solve_one import solve_one
from surfexp.linalg.ldlt_symbolic import analyse
from surfexp.operators.assembly import scatter
from surfexp.operators.assembly_pattern import AssemblyPattern, assembly_pattern
from surfexp.operators.surface_operator import SurfaceOperator

RESIDUAL_LIMIT = 1e-8


class NewtonSystem:
    """Solves (diag(weight) + a sum of element matrices) x = b, factorised in an order that is found once.

    Parameters
    ----------
    operator : SurfaceOperator
        For its faces.
    weight : (n,) float64
        Positive.
    """

    def __init__(self, operator: SurfaceOperator, weight: Floats) -> None:
        self._symbolic = analyse(_matrix(operator.pattern, np.ones(len(operator.pattern.indices))))
        self._order = self._symbolic.permutation
        rank = np.empty_like(self._order)
        rank[self._order] = np.arange(len(rank))
        self._pattern = assembly_pattern(rank[operator.faces], len(rank))
        self._weight = weight[self._order]
        self._factor, self._pivots = np.empty(self._symbolic.entries), np.empty(len(rank))
        self._entries = np.zeros(len(self._pattern.indices))

    def refactor(self, local: Floats) -> None:
        """Factorise with other element matrices (m, 3, 3), symmetric and positive semidefinite."""
        s, pattern = self._symbolic, self._pattern
        self._entries = scatter(local, pattern.slots, len(pattern.indices))
        self._entries[pattern.diagonal] += self._weight
        smallest = SMALLEST_PIVOT * float(self._entries[pattern.diagonal].max())
        eliminate(
            *(pattern.indptr, pattern.indices, self._entries, s.columns, s.row_starts, s.rows, s.parents, s.panels),
            *(smallest, self._factor, self._pivots),
        )

    def solve(self, right_hand_side: Floats) -> Floats:
        """Return x (n,), refined once where rounding shows.

        Raises
        ------
        ValueError
            If the residual is above 1e-8 of the right-hand side even so.
        """
        given = right_hand_side[self._order]
        solution, bound = self._solve(given), RESIDUAL_LIMIT * np.abs(given).max()
        matrix = _matrix(self._pattern, self._entries)
        residual = given - matrix @ solution
        if not np.abs(residual).max() <= bound:
            solution += self._solve(residual)
            residual = given - matrix @ solution
            if not np.abs(residual).max() <= bound:
                share = np.abs(residual).max() / np.abs(given).max()
                raise ValueError(
                    f"Newton's system is solved to {share:.1e} only, at most {RESIDUAL_LIMIT:.0e} is accepted"
                )
        result = np.empty_like(solution)
        result[self._order] = solution
        return result

    def _solve(self, given: Floats) -> Floats:
        s, solution = self._symbolic, given.copy()
        solve_one(s.columns, s.row_starts, s.rows, s.panels, self._factor, self._pivots, solution)
        return solution


def _matrix(pattern: AssemblyPattern, entries: Floats) -> csr_array:
    size = len(pattern.diagonal)
    return csr_array((entries, pattern.indices, pattern.indptr), shape=(size, size))
