"""Complex Hermitian pencils, solved and counted in their real form of twice the size."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.sparse import block_array, csr_array, sparray

from surfexp.contract.arrays import Floats
from surfexp.spectrum.eigensolver import eigenpairs
from surfexp.spectrum.eigensolver_error import EigensolverError

# what the rotation to complex vectors may add to the residual of the real pairs
ROTATION_LOSS = 10.0


def hermitian_pairs(
    stiffness: sparray, mass: sparray, k: int, tolerance: float = 1e-8, threads: int = 1
) -> tuple[Floats, NDArray[np.complex128]]:
    """Find the k lowest pairs of a complex Hermitian pencil, proved complete by the inertia of its real form.

    X + i Y has the real form [[X, -Y], [Y, X]], in which every eigenvalue stands twice: its 2k lowest are the k lowest of the
    pencil. The Gram matrix of the complex vectors that 2k real ones stand for has eigenvalues in pairs 1 + m, 1 - m; the k
    upper ones span a space of dimension k, also where 2k cuts a cluster.

    Parameters
    ----------
    stiffness, mass : (n, n) sparse arrays
        Hermitian, real or complex; the mass positive definite.
    k : int
    tolerance : float
        Largest relative residual of the real form; the complex pairs may have ten times this.
    threads : int
        As in `eigenpairs`.

    Returns
    -------
    (k,) float64
        Increasing.
    (n, k) complex128
        Orthonormal for the mass.

    Raises
    ------
    EigensolverError
        If a matrix is not Hermitian, or no proved pairs can be given.
    """
    n = stiffness.shape[0]
    if not 1 <= k <= n:
        raise EigensolverError(f"k = {k} eigenpairs of {n} degrees of freedom: take 1 <= k <= {n}")
    stiffness, mass = csr_array(stiffness), csr_array(mass)
    system = eigenpairs(_real_form(stiffness), _real_form(mass), 2 * k, tolerance=tolerance, threads=threads)
    complex_vectors = system.vectors[:n] + 1j * system.vectors[n:]
    sizes, mixing = np.linalg.eigh(complex_vectors.conj().T @ (mass @ complex_vectors))
    basis = complex_vectors @ (mixing[:, k:] / np.sqrt(sizes[k:]))
    projected = basis.conj().T @ (stiffness @ basis)
    values, rotation = eigh(0.5 * (projected + projected.conj().T))
    vectors = basis @ rotation
    masses = mass @ vectors
    errors = np.linalg.norm(stiffness @ vectors - masses * values, axis=0) / np.linalg.norm(masses, axis=0)
    worst = float((errors / np.maximum(np.abs(values), system.spacing)).max())
    if not worst <= ROTATION_LOSS * tolerance:
        raise EigensolverError(
            f"a complex pair has residual {worst:.1e}, above {ROTATION_LOSS * tolerance:g}: take another k"
        )
    return values, vectors


def _real_form(matrix: csr_array) -> csr_array:
    real, imaginary = csr_array(matrix.real), csr_array(matrix.imag)
    return csr_array(block_array([[real, -imaginary], [imaginary, real]]))
