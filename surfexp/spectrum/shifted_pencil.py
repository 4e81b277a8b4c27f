"""A symmetric pencil A - s B, factorised at one shift after another."""

from __future__ import annotations

from copy import copy

import numpy as np
from scipy.sparse import csr_array, sparray

from surfexp.contract.arrays import Floats
from surfexp.linalg.block_products import multiply_lanes
from surfexp.linalg.lanes import LANES
from surfexp.linalg.ldlt import LDLT
from surfexp.linalg.ldlt_symbolic import analyse, permuted
from surfexp.spectrum.eigensolver_error import EigensolverError, SliverError

# a shift that solves worse than this lies on an eigenvalue, and another nearby is taken where there is one
WORST_RESIDUAL = 1e-9
# most doubt about an eigenvalue, in mean spacings by Weyl's law, that a factorisation is used with
LARGEST_DOUBT = 1e-2
NUDGES = 6


class ShiftedPencil:
    """Stiffness A and mass B in elimination order, on one pattern, so that A - s B costs one subtraction.

    Parameters
    ----------
    stiffness, mass : (n, n) sparse arrays
        Symmetric; the mass positive definite.

    Attributes
    ----------
    stiffness, mass : (n, n) csr_array
        In elimination order.
    order : (n,) int64
        Row i here is row order[i] of the given matrices.
    counts : dict of float to int
        Eigenvalues below each shift at which the pencil was factorised well.
    doubts : dict of float to float
        How near to the shift an eigenvalue has to lie to have been counted on the wrong side.
    """

    def __init__(self, stiffness: sparray, mass: sparray) -> None:
        pattern = _ones(stiffness) + _ones(mass)
        self.symbolic = analyse(pattern)
        self.order = self.symbolic.permutation
        self._pattern = permuted(csr_array(pattern), self.order)
        self.stiffness = permuted(csr_array(stiffness, dtype=np.float64), self.order)
        self.mass = permuted(csr_array(mass, dtype=np.float64), self.order)
        self._stiffness_entries = _entries_on(self._pattern, self.stiffness)
        self._mass_entries = _entries_on(self._pattern, self.mass)
        diagonal = self.mass.diagonal()
        self._diagonal = diagonal[:, None] if self.mass.nnz == np.count_nonzero(diagonal) else None
        self._factors: LDLT | None = None
        self.counts: dict[float, int] = {}
        self.doubts: dict[float, float] = {}
        self._require_semidefinite_mass()

    @property
    def size(self) -> int:
        """Number of rows."""
        return len(self.order)

    def with_own_factors(self) -> ShiftedPencil:
        """Return the same matrices and analysis with counts and factors of their own, for another thread."""
        other = copy(self)
        other._factors, other.counts, other.doubts = None, dict(self.counts), dict(self.doubts)
        return other

    def multiply_mass(self, block: Floats, result: Floats | None = None) -> Floats:
        """Return B X, C-ordered; in `result` where that is given and the block has eight columns."""
        if self._diagonal is not None:
            return np.multiply(self._diagonal, block, order="C")
        block = np.ascontiguousarray(block)
        return multiply_lanes(self.mass, block, result) if block.shape[1] == LANES else self.mass @ block

    def factor(self, shift: float, accuracy: float = 1.0, room: float = np.inf) -> tuple[float, LDLT]:
        """Factorise A - s B at the shift, or near it where the pivots are bad there.

        Parameters
        ----------
        shift : float
        accuracy : float
            Doubt, relative to the shift, that is good enough to stop looking for a better shift nearby.
        room : float
            How far another shift may lie: one for an edge must stay in its gap.

        Returns
        -------
        shift : float
            The shift that was used; `counts` knows how many eigenvalues lie below it.
        factors : LDLT
            Of the shift, until this is called again: there is memory for one.

        Raises
        ------
        EigensolverError
            If rounding leaves the eigenvalues in doubt by more than a hundredth of their mean spacing at every shift nearby.
        """
        spacing = 4.0 * np.pi / float(self.mass.sum())
        scale = 1e-3 * (abs(shift) or spacing / (4.0 * np.pi))
        step = min(scale, room / NUDGES)
        candidates: list[tuple[bool, float, float]] = []
        least, tried = np.inf, shift
        for nudge in range(NUDGES):
            tried = float(shift + step * nudge * (-1) ** nudge)
            factors = self._at(tried)
            doubt = 10.0 * factors.perturbation * self.size / float(self.mass.sum())
            least = min(least, doubt)
            if doubt <= LARGEST_DOUBT * max(abs(tried), spacing) and not factors.replaced_pivots:
                self.counts[tried], self.doubts[tried] = factors.inertia[0], doubt
                on_eigenvalue = factors.residual > WORST_RESIDUAL
                candidates.append((on_eigenvalue, doubt, tried))
                if doubt <= accuracy * max(abs(tried), scale) and not on_eigenvalue:
                    break
        if not candidates:
            raise SliverError(
                f"A - s B near s = {shift:g} leaves eigenvalues in doubt by {least:.1e}, at most "
                f"{LARGEST_DOUBT * max(abs(shift), spacing):.1e} is accepted: repair slivers and faces of nearly no area, "
                "or take operator intrinsic_delaunay"
            )
        best = min(candidates)[-1]
        return best, factors if best == tried else self._at(best)

    def _require_semidefinite_mass(self) -> None:
        """Counts mean nothing with another mass. Linear elements have a dominant diagonal; others are factorised."""
        off_diagonal = abs(self.mass).sum(axis=1) - self.mass.diagonal()
        if (off_diagonal <= (1.0 + 1e-12) * self.mass.diagonal()).all():
            return
        negative = self._factorised(self._mass_entries).inertia[0]
        if negative:
            raise EigensolverError(
                f"the mass matrix is not positive definite, {negative} of its {self.size} eigenvalues are negative: "
                "repair the mesh or give another mass"
            )

    def _factorised(self, entries: Floats) -> LDLT:
        """Factorise a matrix on the common pattern in the memory of the last one."""
        matrix = csr_array((entries, self._pattern.indices, self._pattern.indptr), shape=self._pattern.shape)
        if self._factors is None:
            self._factors = LDLT(matrix, self.symbolic)
        else:
            self._factors.refactor_in_order(matrix)
        return self._factors

    def _at(self, shift: float) -> LDLT:
        return self._factorised(self._stiffness_entries - shift * self._mass_entries)


def _ones(matrix: sparray) -> csr_array:
    ones = csr_array(matrix, dtype=np.float64, copy=True)
    ones.sum_duplicates()
    ones.data[:] = 1.0
    return ones


def _entries_on(pattern: csr_array, matrix: csr_array) -> Floats:
    """Return the entries of `matrix` at the places of a larger pattern, zero where it has none."""
    if matrix.nnz == pattern.nnz:
        return matrix.data
    result = np.zeros(pattern.nnz)
    result[np.searchsorted(_keys(pattern), _keys(matrix))] = matrix.data
    return result


def _keys(matrix: csr_array) -> np.ndarray:
    rows = np.repeat(np.arange(matrix.shape[0]), np.diff(matrix.indptr))
    return rows * matrix.shape[1] + matrix.indices.astype(np.int64)
