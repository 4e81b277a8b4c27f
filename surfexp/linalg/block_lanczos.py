"""Block Lanczos for a shifted and inverted symmetric pencil, resumable step by step.

By hand: ARPACK, behind SciPy's `eigsh`, iterates with one vector, cannot be stopped to look and grown further, and takes its solves
one at a time. It left pairs out in 25 of 306 runs on icospheres, whose eigenvalues are multiple (`docs/missing_eigenpairs.md`).
SciPy's `lobpcg` is no Krylov method: without a factorisation its residuals stall near 1e-5.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh, solve_triangular

from surfexp.contract.arrays import Floats
from surfexp.linalg.block_products import gram, multiply_right, subtract_product, subtract_two

BLOCK = 8
ROWS_AT_ONCE = 4096
REORTHOGONALISE_EVERY = 3
DRIFT_LIMIT, SEVERE_DRIFT = 1e-9, 1e-7
DEPENDENT = 1e-11
CANCELLED = 1e-6
VANISHED = 1e-10


@dataclass(frozen=True, eq=False)
class RitzPairs:
    """Approximate eigenpairs of a basis.

    Parameters
    ----------
    values : (m,) float64
        Eigenvalues theta of (A - sigma B)^-1 B.
    coefficients : (m, m) float64
        Their vectors in the basis.
    residuals : (m,) float64
        B-norm of (A - sigma B)^-1 B x - theta x.
    """

    values: Floats
    coefficients: Floats
    residuals: Floats


class BlockLanczos:
    """A B-orthonormal basis V of the Krylov space of (A - sigma B)^-1 B, grown eight vectors at a time.

    The operator is symmetric in the inner product of B, so V^T B (A - sigma B)^-1 B V is block tridiagonal (Grimes, Lewis
    and Simon 1994). The newest two blocks are orthogonalised against all the others at every third step, more often once
    orthogonality drifts.

    Parameters
    ----------
    solve : callable
        Overwrites an (n, 8) C-ordered block X by (A - sigma B)^-1 X.
    multiply_mass : callable
        Returns B X, C-ordered; may write it to the array that comes as second argument.
    size : int
        n.
    capacity : int
        Most vectors that the basis may have; rounded up to whole blocks.
    locked : (n, q) float64, optional
        B-orthonormal eigenvectors that the basis is kept orthogonal to.
    seed : int
        Of the random first block.
    """

    def __init__(
        self,
        solve: Callable[[Floats], None],
        multiply_mass: Callable[[Floats, Floats | None], Floats],
        size: int,
        capacity: int,
        locked: Floats | None = None,
        seed: int = 0,
    ) -> None:
        self._solve, self._multiply_mass = solve, multiply_mass
        self._random = np.random.default_rng(seed)
        self._locked = 0 if locked is None else locked.shape[1]
        self._storage = np.empty(size * (self._locked + (capacity // BLOCK + 2) * BLOCK))
        self._basis = self._storage.reshape((size, -1), order="F")
        if locked is not None:
            self._basis[:, : self._locked] = locked
        self.capacity = capacity
        self._projected = np.zeros((capacity + 2 * BLOCK, capacity + 2 * BLOCK))
        self._period = REORTHOGONALISE_EVERY
        self._since = 0
        self.drift = 0.0
        self.dimension = 0
        # kept for the whole run: fresh pages from the system cost as much as the work on them
        self._mass_next, self._spare, self._scratch, self._before = (np.zeros((size, BLOCK)) for _ in range(4))
        self._pair, self._common = np.empty((size, 2 * BLOCK)), np.empty((2 * BLOCK, size))
        start = multiply_mass(self._random.normal(size=(size, BLOCK)), None)
        solve(start)
        self._next, self._mass_next, _ = self._orthonormalise(self._purge(self._purge(start)), 0.0)
        self._coupling = np.zeros((BLOCK, BLOCK))

    def extend(self) -> None:
        """Append the next block to the basis and work out the one after it."""
        first, last = self._locked + self.dimension, self._locked + self.dimension + BLOCK
        self._basis[:, first:last] = self._next
        self._write_coupling()
        block, mass_block, new = self._next, self._mass_next, self._spare
        np.copyto(new, mass_block)
        self._solve(new)
        diagonal = gram(mass_block, new)
        size = float(np.sqrt((self._coupling.T**2 + diagonal**2).sum(axis=0).max()))
        subtract_two(new, self._before, np.ascontiguousarray(self._coupling.T), block, diagonal)
        correction = gram(mass_block, new)
        diagonal += correction
        here = slice(self.dimension, self.dimension + BLOCK)
        self._projected[here, here] = 0.5 * (diagonal + diagonal.T)
        self.dimension += BLOCK
        self._since += 1
        if self._since >= self._period and first:
            self._reorthogonalise(new, mass_block, first)
        else:
            subtract_product(new, block, correction)
        self._spare, self._before = self._before, block
        self._next, self._mass_next, self._coupling = self._orthonormalise(new, size)

    def ritz(self) -> RitzPairs:
        """Return the eigenpairs of the projected operator, by increasing value."""
        m = self.dimension
        values, coefficients = eigh(self._projected[:m, :m], driver="evd", check_finite=False)
        residuals = np.linalg.norm(self._coupling @ coefficients[m - BLOCK :], axis=0)
        return RitzPairs(values, coefficients, residuals)

    def vectors(self, ritz: RitzPairs, selected: np.ndarray) -> Floats:
        """Return the B-normalised vectors of some Ritz pairs, after one free step of inverse iteration.

        They take the place of the basis, which ends with this call.

        (A - sigma B)^-1 B x / theta needs no solve, as x lies in the basis and the next block is known (the purification
        of Ericsson and Ruhe 1980).

        Parameters
        ----------
        ritz : RitzPairs
            Of the present basis.
        selected : index array

        Returns
        -------
        (n, len(selected)) float64, Fortran order
        """
        m = self.dimension
        chosen = ritz.coefficients[:, selected]
        weights = np.concatenate([chosen, (self._coupling @ chosen[m - BLOCK :]) / ritz.values[selected]])
        weights /= np.linalg.norm(weights, axis=0)
        self._basis[:, self._locked + m : self._locked + m + BLOCK] = self._next
        basis = self._basis[:, self._locked :]
        for start in range(0, len(basis), ROWS_AT_ONCE):
            rows = slice(start, start + ROWS_AT_ONCE)
            basis[rows, : len(selected)] = basis[rows, : m + BLOCK] @ weights
        size, kept = len(basis), self._locked + len(selected)
        del basis, self._basis
        self._storage.resize(size * kept, refcheck=False)
        return self._storage.reshape((size, kept), order="F")[:, self._locked :]

    def _write_coupling(self) -> None:
        if self.dimension:
            before = slice(self.dimension - BLOCK, self.dimension)
            here = slice(self.dimension, self.dimension + BLOCK)
            self._projected[here, before] = self._coupling
            self._projected[before, here] = self._coupling.T

    def _reorthogonalise(self, new: Floats, mass_block: Floats, older: int) -> None:
        """Remove what the newest basis block and the next one have in common with all before, in place."""
        self._pair[:, :BLOCK] = mass_block
        self._pair[:, BLOCK:] = self._multiply_mass(new, self._scratch)
        overlap = self._pair.T @ self._basis[:, :older]
        drift = float(np.abs(overlap[:BLOCK]).max())
        self.drift = max(self.drift, drift)
        if drift > DRIFT_LIMIT:
            self._period = 2 if drift < SEVERE_DRIFT else 1
        common = np.matmul(overlap, self._basis[:, :older].T, out=self._common)
        block = self._next
        block -= common[:BLOCK].T
        self._basis[:, older : older + BLOCK] = block
        new -= common[BLOCK:].T
        subtract_product(new, block, gram(self._multiply_mass(block, self._scratch), new))
        self._since = 0

    def _purge(self, block: Floats) -> Floats:
        """Return the block without its part in the locked vectors and the basis."""
        known = self._basis[:, : self._locked + self.dimension]
        return np.ascontiguousarray(block - known @ (known.T @ self._multiply_mass(block, None)))

    def _orthonormalise(self, block: Floats, size: float) -> tuple[Floats, Floats, Floats]:
        """Return Q (in place of the block), B Q and R with block = Q R and Q^T B Q = I; dependent columns become random.

        A column is dependent also where little is left of the `size` that was taken off in orthogonalising it.
        """
        factor = np.eye(BLOCK)
        for attempt in range(2):
            mass_block = self._multiply_mass(block, self._mass_next)
            products = gram(block, mass_block)
            scale = np.sqrt(np.maximum(products.diagonal(), np.finfo(float).tiny))
            correlation = products / np.outer(scale, scale)
            cancelled = not attempt and scale.min() < CANCELLED * size
            if cancelled or np.linalg.eigvalsh(correlation)[0] < DEPENDENT:
                return self._replace_dependent(block, size)
            upper = np.linalg.cholesky(0.5 * (correlation + correlation.T)).T * scale
            inverse = np.ascontiguousarray(solve_triangular(upper, np.eye(BLOCK)))
            multiply_right(block, inverse)
            multiply_right(mass_block, inverse)
            factor = upper @ factor
            if np.linalg.cond(correlation) < 1e4:
                break
        return block, mass_block, factor

    def _replace_dependent(self, block: Floats, size: float) -> tuple[Floats, Floats, Floats]:
        """Gram-Schmidt column by column; a column that vanishes is replaced by a random one, with a zero row in R."""
        result, factor = np.zeros_like(block), np.zeros((BLOCK, BLOCK))
        largest = max(size, float(self._norms(block).max()))
        for c in range(BLOCK):
            column = block[:, c : c + 1].copy()
            factor[:, c : c + 1] = result.T @ self._multiply_mass(column, None)
            column -= result @ factor[:, c : c + 1]
            norm = float(self._norms(column)[0])
            if norm > VANISHED * largest:
                factor[c, c] = norm
            else:
                column, norm = self._random.normal(size=column.shape), 1.0
            # what is left of a nearly dependent column is mostly rounding, so it is made orthogonal to everything again
            column /= norm
            for _ in range(3):
                column = self._purge(column)
                column -= result @ (result.T @ self._multiply_mass(column, None))
                column /= self._norms(column)
            result[:, c] = column[:, 0]
        return result, self._multiply_mass(result, self._mass_next), factor

    def _norms(self, block: Floats) -> Floats:
        return np.sqrt(np.einsum("ij,ij->j", block, self._multiply_mass(block, None)))
