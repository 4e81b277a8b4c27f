"""LOBPCG: eigenpairs without a complete factorisation."""

from __future__ import annotations

import warnings
from importlib import import_module
from typing import Any

import numpy as np
from scipy.sparse import csc_array, csr_array
from scipy.sparse.linalg import LinearOperator, spilu
from scipy.sparse.linalg import lobpcg as scipy_lobpcg

from surfexp.contract.arrays import Floats
from surfexp.spectrum.eigensystem import EigenSystem, measure, measured

ITERATIONS = 400
GUARDS = 6


def lobpcg(stiffness: csr_array, mass: csr_array, k: int, tolerance: float = 1e-6, seed: int = 0) -> EigenSystem:
    """Find about the k lowest pairs (Knyazev 2001), preconditioned by multigrid on A + s B.

    Nothing proves that none is missing. A few more vectors than k are iterated, since the last ones converge slowly.
    """
    n = stiffness.shape[0]
    shift = 4.0 * np.pi / float(mass.sum())
    preconditioner, said = _preconditioner(csr_array(stiffness + shift * mass))
    count = min(k + max(GUARDS, k // 5), n // 4)
    start = np.random.default_rng(seed).normal(size=(n, count))
    # |A x - lambda B x| of a B-normalised vector, at which its relative residual is half the tolerance
    enough = 0.5 * tolerance * shift * float(np.sqrt(mass.sum() / n))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        values, vectors = scipy_lobpcg(
            *(stiffness, start, mass, preconditioner), tol=enough, maxiter=ITERATIONS, largest=False
        )
    order = np.argsort(values)[:k]
    lowest = np.asfortranarray(vectors[:, order])
    system = measured(measure(stiffness, mass, lowest), lowest, "lobpcg")
    late = int((system.residuals > tolerance).sum())
    notes: tuple[str, ...] = (f"without a factorisation nothing proves that no eigenvalue is missing; {said}",)
    if late:
        notes += (f"{late} of {k} pairs miss the tolerance {tolerance:g}, the worst is {system.residuals.max():.1e}",)
    return EigenSystem(**{**system.__dict__, "notes": notes})


def _preconditioner(matrix: csr_array) -> tuple[LinearOperator, str]:
    """One cycle of smoothed aggregation where pyamg is installed, else an incomplete LU; with its name."""
    n = matrix.shape[0]
    try:
        multigrid: Any = import_module("pyamg")
    except ImportError:
        incomplete = spilu(csc_array(matrix), drop_tol=1e-4, fill_factor=12.0)
        solve, said = incomplete.solve, "preconditioned by an incomplete LU, since pyamg is not installed"
    else:
        from scipy.sparse import csr_matrix

        levels = multigrid.smoothed_aggregation_solver(csr_matrix(matrix), np.ones((n, 1)), max_coarse=200)
        cycle = levels.aspreconditioner(cycle="V")

        def solve(load: Floats) -> Floats:
            columns = load.reshape(n, -1).T
            return np.stack([cycle.matvec(column) for column in columns], axis=1).reshape(load.shape)

        said = f"preconditioned by multigrid on {len(levels.levels)} levels"
    return LinearOperator((n, n), matvec=solve, matmat=solve, dtype=np.float64), said
