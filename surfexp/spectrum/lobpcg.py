"""LOBPCG: eigenpairs without a complete factorisation."""

from __future__ import annotations

import warnings

import numpy as np
from scipy.sparse import csc_array, csr_array
from scipy.sparse.linalg import LinearOperator, spilu
from scipy.sparse.linalg import lobpcg as scipy_lobpcg

from surfexp.spectrum.eigensystem import EigenSystem, measure, measured

ITERATIONS = 400
GUARDS = 6


def lobpcg(stiffness: csr_array, mass: csr_array, k: int, tolerance: float = 1e-6, seed: int = 0) -> EigenSystem:
    """Find about the k lowest pairs (Knyazev 2001), preconditioned by an incomplete LU of A + s B.

    Nothing proves that none is missing. A few more vectors than k are iterated, since the last ones converge slowly.
    """
    n = stiffness.shape[0]
    shift = 4.0 * np.pi / float(mass.sum())
    incomplete = spilu(csc_array(stiffness + shift * mass), drop_tol=1e-4, fill_factor=12.0)
    preconditioner = LinearOperator((n, n), matvec=incomplete.solve, matmat=incomplete.solve, dtype=np.float64)
    count = min(k + max(GUARDS, k // 5), n // 4)
    start = np.random.default_rng(seed).normal(size=(n, count))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        values, vectors = scipy_lobpcg(
            *(stiffness, start, mass, preconditioner), tol=tolerance * shift, maxiter=ITERATIONS, largest=False
        )
    order = np.argsort(values)[:k]
    lowest = np.asfortranarray(vectors[:, order])
    system = measured(measure(stiffness, mass, lowest), lowest, "lobpcg")
    late = int((system.residuals > tolerance).sum())
    notes: tuple[str, ...] = ("without a factorisation nothing proves that no eigenvalue is missing",)
    if late:
        notes += (f"{late} of {k} pairs miss the tolerance {tolerance:g}, the worst is {system.residuals.max():.1e}",)
    return EigenSystem(**{**system.__dict__, "notes": notes})
