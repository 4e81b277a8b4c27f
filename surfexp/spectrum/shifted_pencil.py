"""A symmetric pencil A - s B, factorised at one shift after another."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array, sparray

from surfexp.linalg.block_products import multiply_lanes
from surfexp.linalg.lanes import LANES
from surfexp.linalg.ldlt import LDLT
from surfexp.linalg.ldlt_symbolic import analyse, permuted
from surfexp.mesh.triangle_mesh import Floats

WORST_RESIDUAL = 1e-9
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

    @property
    def size(self) -> int:
        """Number of rows."""
        return len(self.order)

    def multiply_mass(self, block: Floats, result: Floats | None = None) -> Floats:
        """Return B X, C-ordered; in `result` where that is given and the block has eight columns."""
        if self._diagonal is not None:
            return np.multiply(self._diagonal, block, order="C")
        block = np.ascontiguousarray(block)
        return multiply_lanes(self.mass, block, result) if block.shape[1] == LANES else self.mass @ block

    def factor(self, shift: float, accuracy: float = 1.0) -> tuple[float, LDLT]:
        """Factorise A - s B at the shift, or near it where the pivots are bad there.

        Parameters
        ----------
        shift : float
        accuracy : float
            Doubt, relative to the shift, that is good enough to stop looking for a better shift nearby.

        Returns
        -------
        shift : float
            The shift that was used; `counts` knows how many eigenvalues lie below it.
        factors : LDLT
            Of the shift, until this is called again: there is memory for one.

        Raises
        ------
        ValueError
            If no shift nearby solves to a residual of 1e-9.
        """
        step = 1e-3 * (abs(shift) or 1.0 / float(self.mass.sum()))
        found: list[tuple[float, float]] = []
        worst, tried = np.inf, shift
        for nudge in range(NUDGES):
            tried = float(shift + step * nudge * (-1) ** nudge)
            factors = self._factorised(tried)
            doubt = 10.0 * factors.perturbation * self.size / float(self.mass.sum())
            worst = min(worst, factors.residual)
            if factors.residual <= WORST_RESIDUAL and not factors.replaced_pivots:
                self.counts[tried], self.doubts[tried] = factors.inertia[0], doubt
                found.append((doubt, tried))
                if doubt <= accuracy * max(abs(tried), step):
                    break
        if not found:
            raise ValueError(
                f"A - s B solves with residual {worst:.1e} at best near s = {shift:g}, at most {WORST_RESIDUAL:.0e} is "
                "accepted: repair slivers or faces of nearly no area"
            )
        best = min(found)[1]
        return best, factors if best == tried else self._factorised(best)

    def _factorised(self, shift: float) -> LDLT:
        """Factorise in the memory of the last shift."""
        if self._factors is None:
            self._factors = LDLT(self._shifted(shift), self.symbolic)
        else:
            self._factors.refactor(self._shifted(shift))
        return self._factors

    def _shifted(self, shift: float) -> csr_array:
        entries = self._stiffness_entries - shift * self._mass_entries
        return csr_array((entries, self._pattern.indices, self._pattern.indptr), shape=self._pattern.shape)


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
