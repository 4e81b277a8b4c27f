"""Sparse LDL^T of symmetric matrices, definite or not: many right-hand sides, cheap refactoring, inertia.

By hand: no library under a free licence without copyleft has both the counts of negative pivots, which prove spectra
complete, and solves with many right-hand sides. CHOLMOD's supernodal part is GPL and for definite matrices alone,
SuperLU knows no symmetry and takes three to four times as long, qdldl works column by column.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csr_array, issparse, sparray, spmatrix

from surfexp.contract.arrays import Floats
from surfexp.linalg.lanes import LANES
from surfexp.linalg.ldlt_numeric import eliminate
from surfexp.linalg.ldlt_solve import solve_lanes
from surfexp.linalg.ldlt_solve_one import solve_one
from surfexp.linalg.ldlt_symbolic import SymbolicFactor, analyse
from surfexp.linalg.symmetric_matrix import in_elimination_order, symmetric_rows

SMALLEST_PIVOT = 1e-14
# backward error of a first solve above which solves are refined, and its residual above which the factors are refused
REFINED, REFUSED = 1e-14, 1e-3
REFINEMENTS = 3
# fewer right-hand sides than that are solved with one by one
FEW = 3


class LDLT:
    """Factors P A P^T = L D L^T of a sparse symmetric matrix, with diagonal D and without pivoting; `sx.ldlt` makes one.

    A factor can be called as a function: `factor(b)` is `factor.solve(b)`, so that it stands wherever a CHOLMOD factor or
    the solve of `scipy.sparse.linalg.splu` is expected.

    Parameters
    ----------
    matrix : (n, n) csr_array
        Symmetric, both triangles present, in elimination order (see `ldlt_symbolic.permuted`).
    symbolic : SymbolicFactor
        The analysis of the pattern.

    Attributes
    ----------
    matrix, symbolic
        As given.
    replaced_pivots : int
        How many pivots were under 1e-14 of the least diagonal entry that is not 0 (in modulus), replaced by that bound.
    residual : float
        |A x - b| / |b| of a first solve with fixed right-hand sides.
    backward_error : float
        Largest |A x - b| / (|A| |x| + |b|) of that solve, in the maximum norm. Solves are refined where it is above 1e-14.
    perturbation : float
        |A x - b| / |x| of that solve. As x is mostly made of the eigenvectors nearest to zero, this is about how far the
        eigenvalues nearest to zero have moved: the inertia is exact when all are farther from zero than that.
    row_errors, row_sizes : (n,) float64
        What that ratio is made of, row by row in elimination order: the parts of a block diagonal matrix are judged apart.

    Raises
    ------
    ValueError
        If the matrix has entries that are not finite, or another size than the analysis.
    """

    def __init__(self, matrix: csr_array, symbolic: SymbolicFactor) -> None:
        if matrix.shape[0] != symbolic.size:
            raise ValueError(f"matrix has {matrix.shape[0]} rows, the analysis is of one with {symbolic.size}")
        self.symbolic = symbolic
        self._factor = np.empty(symbolic.entries)
        self._pivots = np.empty(symbolic.size)
        self.refactor_in_order(matrix)

    def refactor(self, matrix: ArrayLike | sparray | spmatrix) -> None:
        """Replace the factors by those of another matrix of the same pattern.

        Parameters
        ----------
        matrix : (n, n) sparse array
            Symmetric; its entries that are not 0 must lie where the factor has some, as those of the first matrix do.

        Raises
        ------
        ValueError
            If the matrix is not symmetric, has entries elsewhere, or is singular to rounding. The factors are then those of
            no matrix.
        """
        self.refactor_in_order(in_elimination_order(symmetric_rows(matrix), self.symbolic))
        self._require_regular()

    def refactor_in_order(self, matrix: csr_array) -> None:
        """Replace the factors by those of a matrix in elimination order, of which only the finiteness is checked.

        Parameters
        ----------
        matrix : (n, n) csr_array
            As `permuted` returns it.

        Raises
        ------
        ValueError
            If it has entries that are not finite.
        """
        if not np.isfinite(matrix.data).all():
            raise ValueError(f"matrix has {int((~np.isfinite(matrix.data)).sum())} entries that are not finite")
        self.matrix = matrix
        s = self.symbolic
        diagonal = np.abs(matrix.diagonal())
        scale = float(diagonal.min(initial=np.inf, where=diagonal > 0))
        self._smallest = SMALLEST_PIVOT * (scale if np.isfinite(scale) else 1.0)
        self.replaced_pivots = int(
            eliminate(
                *(matrix.indptr, matrix.indices, matrix.data),
                *(s.columns, s.row_starts, s.rows, s.parents, s.panels),
                *(self._smallest, self._factor, self._pivots),
            )
        )
        probe = np.cos(np.outer(np.arange(s.size), np.arange(1.0, LANES + 1)))
        solution = probe.copy()
        self.solve_in_order(solution)
        defect = matrix @ solution - probe
        self.row_errors, self.row_sizes = _norm(defect, axis=1), _norm(solution, axis=1)
        error = float(_norm(self.row_errors))
        self.residual = error / float(_norm(probe))
        self.perturbation = error / float(_norm(self.row_sizes))
        largest = float(abs(matrix).sum(axis=1).max())
        self.backward_error = float(np.abs(defect).max() / (largest * np.abs(solution).max() + np.abs(probe).max()))

    @property
    def shape(self) -> tuple[int, int]:
        """Shape of the matrix."""
        return self.symbolic.size, self.symbolic.size

    @property
    def negative(self) -> NDArray[np.bool_]:
        """(n,) which pivots are negative, in elimination order."""
        return np.asarray(self._pivots < 0)

    @property
    def inertia(self) -> tuple[int, int]:
        """Numbers of negative and of positive eigenvalues."""
        negative = int(self.negative.sum())
        return negative, self.symbolic.size - negative

    @property
    def memory(self) -> int:
        """Bytes of the factors and their analysis."""
        s = self.symbolic
        analysis = (s.permutation, s.columns, s.row_starts, s.rows, s.parents, s.panels)
        return int(self._factor.nbytes + self._pivots.nbytes + sum(part.nbytes for part in analysis))

    def slogdet(self) -> tuple[float, float]:
        """Return the determinant as `numpy.linalg.slogdet` does.

        Returns
        -------
        sign : float
            1 or -1.
        logarithm : float
            Of the modulus.
        """
        return (-1.0) ** self.inertia[0], math.fsum(np.log(np.abs(self._pivots)))

    def logdet(self) -> float:
        """Return the logarithm of the determinant.

        Returns
        -------
        float
            NaN where the determinant is negative.
        """
        sign, logarithm = self.slogdet()
        return logarithm if sign > 0 else math.nan

    def solve_in_order(self, right_hand_sides: Floats) -> None:
        """Overwrite eight right-hand sides by their solutions.

        Parameters
        ----------
        right_hand_sides : (n, 8) float64
            C-ordered, rows in elimination order.
        """
        s = self.symbolic
        solve_lanes(s.columns, s.row_starts, s.rows, s.panels, self._factor, self._pivots, right_hand_sides)

    def solve(self, right_hand_side: ArrayLike) -> Floats:
        """Return x with A x = b.

        Parameters
        ----------
        right_hand_side : (n,) or (n, c) array
            One or many; eight at once cost about as much as two.

        Returns
        -------
        (n,) or (n, c) float64

        Raises
        ------
        ValueError
            If the lengths differ, or it is sparse or complex.
        """
        if issparse(right_hand_side):
            raise ValueError("right-hand side is sparse, its solution is dense: give b.toarray()")
        if np.iscomplexobj(right_hand_side):
            raise ValueError("right-hand side is complex: solve with its real and its imaginary part")
        given = np.asarray(right_hand_side, dtype=np.float64)
        order = self.symbolic.permutation
        if given.ndim not in (1, 2) or len(given) != len(order):
            raise ValueError(f"right-hand side has {len(given) if given.ndim else 0} rows, the matrix has {len(order)}")
        load = given.reshape(len(order), -1)[order]
        solution = self._solve(load)
        if self.backward_error > REFINED:
            solution = self._refined(load, solution)
        result = np.empty_like(solution)
        result[order] = solution
        return result.reshape(given.shape)

    __call__ = solve

    def _solve(self, load: Floats) -> Floats:
        s, solution = self.symbolic, np.empty_like(load)
        if load.shape[1] < FEW:
            for column in range(load.shape[1]):
                one = load[:, column].copy()
                solve_one(s.columns, s.row_starts, s.rows, s.panels, self._factor, self._pivots, one)
                solution[:, column] = one
            return solution
        for first in range(0, load.shape[1], LANES):
            some = slice(first, min(first + LANES, load.shape[1]))
            block = np.zeros((len(load), LANES))
            block[:, : some.stop - some.start] = load[:, some]
            self.solve_in_order(block)
            solution[:, some] = block[:, : some.stop - some.start]
        return solution

    def _refined(self, load: Floats, solution: Floats) -> Floats:
        """Take the solution's defect off it while that makes the defect smaller."""
        defect = load - self.matrix @ solution
        for _ in range(REFINEMENTS):
            better = solution + self._solve(defect)
            left = load - self.matrix @ better
            if not np.linalg.norm(left) < np.linalg.norm(defect):
                break
            solution, defect = better, left
        return solution

    def _require_regular(self) -> None:
        if self.replaced_pivots:
            row = int(self.symbolic.permutation[np.argmax(np.abs(self._pivots) <= self._smallest)])
            raise ValueError(
                f"matrix is singular to rounding or needs pivoting, {self.replaced_pivots} of its {self.symbolic.size} pivots are "
                f"below {self._smallest:.1e}, the first of row {row}: shift it, as in A - s M with s no eigenvalue, or fix a row"
            )
        if not self.residual <= REFUSED:
            raise ValueError(
                f"matrix is singular to rounding, a first solve leaves {self.residual:.1e} of its right-hand side, at most "
                f"{REFUSED:.0e} is accepted: shift it, as in A - s M with s no eigenvalue, or fix a row"
            )


def _norm(values: Floats, axis: int | None = None) -> Floats:
    """Euclidean norm of numbers of any size: those whose squares are no numbers are scaled by a power of two."""
    power = int(np.frexp(np.abs(values).max(initial=0.0))[1])
    return np.asarray(np.ldexp(np.linalg.norm(np.ldexp(values, -power), axis=axis), power))


def ldlt(matrix: ArrayLike | sparray | spmatrix, symbolic: SymbolicFactor | None = None) -> LDLT:
    """Factorise a sparse symmetric matrix, definite or not, as P A P^T = L D L^T.

    Multifrontal elimination of supernodes (Duff and Reid 1983) in an order by nested dissection, without pivoting. That is
    stable for definite matrices; for others a first solve measures the digits that are left, later ones are refined, and
    factors that solve badly are refused.

    Parameters
    ----------
    matrix : (n, n) sparse array or array_like
        Real and symmetric; both triangles present.
    symbolic : SymbolicFactor, optional
        The analysis of a matrix of the same pattern (`factor.symbolic`), which saves repeating it.

    Returns
    -------
    LDLT
        `solve` (or a call) solves, `refactor` takes another matrix of the same pattern at a third of the price, `inertia` has
        the numbers of negative and positive eigenvalues, `logdet` and `slogdet` the determinant, `memory` the bytes.

    Raises
    ------
    ValueError
        If the matrix is not square, not symmetric or complex, has entries that are not finite, another size than the
        analysis or entries where it has none, or is singular to rounding, or an indefinite one meets pivots of 0.

    Examples
    --------
    >>> import numpy as np
    >>> import surfexp as sx
    >>> from scipy.sparse import diags_array
    >>> path = diags_array([np.full(99, -1.0), np.full(100, 2.0), np.full(99, -1.0)], offsets=[-1, 0, 1])
    >>> factor = sx.ldlt(path)
    >>> x = factor.solve(np.ones(100))
    >>> bool(abs(path @ x - 1.0).max() < 1e-10)
    True
    >>> round(float(np.exp(factor.logdet())), 9)  # n + 1
    101.0
    >>> factor.refactor(path - 1.1 * diags_array(np.ones(100)))
    >>> factor.inertia  # 35 eigenvalues 2 - 2 cos(k pi / 101) are below 1.1
    (35, 65)
    """
    given = symmetric_rows(matrix)
    if not isinstance(symbolic, SymbolicFactor | None):
        raise ValueError(
            f"symbolic is a {type(symbolic).__name__}, the analysis of another factor is needed: give factor.symbolic, or "
            "matrix + beta I where beta is meant to be added"
        )
    symbolic = analyse(given) if symbolic is None else symbolic
    factor = LDLT(in_elimination_order(given, symbolic), symbolic)
    factor._require_regular()
    return factor
