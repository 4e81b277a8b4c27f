"""The first k eigenpairs of a surface: one entry point, four methods, one kind of result."""

from __future__ import annotations

from functools import partial

import numpy as np
from scipy.sparse import csr_array, sparray

from surfexp.spectrum.arpack import arpack
from surfexp.spectrum.component_counts import component_labels
from surfexp.spectrum.components import solve_components
from surfexp.spectrum.dense import LARGEST_DENSE_SIZE, dense
from surfexp.spectrum.eigensolver_error import EigensolverError
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.lobpcg import lobpcg
from surfexp.spectrum.pencil_checks import certified, check_pencil, check_request
from surfexp.spectrum.single_slice import Progress
from surfexp.spectrum.slicing import slicing

METHODS = ("auto", "slicing", "arpack", "lobpcg", "dense")
DENSE_SIZE = 400


def eigenpairs(
    stiffness: sparray,
    mass: sparray,
    k: int,
    method: str = "auto",
    tolerance: float = 1e-8,
    seed: int = 0,
    progress: Progress | None = None,
    threads: int = 1,
) -> EigenSystem:
    """Find the k lowest pairs of A x = lambda B x (3.17).

    Parameters
    ----------
    stiffness, mass : (n, n) sparse arrays
        Symmetric; the mass positive definite.
    k : int
        How many pairs.
    method : "auto", "slicing", "arpack", "lobpcg" or "dense"
        `slicing` is complete by inertia and fastest; `arpack` is the reference; `lobpcg` needs no factorisation, for graphs
        too large to have one, and proves nothing; `dense` is for small matrices, or when k is a large part of n. "auto"
        is dense up to 400 rows or where k is over a quarter of n, else slicing.
    tolerance : float
        Largest relative residual (see `EigenSystem`), between 1e-12 and 1e-2.
    seed : int
    progress : callable, optional
        Receives the number of pairs found and the fraction that is still missing.
    threads : int
        Of `slicing`, for more than 200 pairs; the result has the same bytes for any number of them.

    Returns
    -------
    EigenSystem
        Complete, unless by lobpcg, and with residuals up to the tolerance.

    Raises
    ------
    EigensolverError
        If the request or a matrix is unfit, or no certified pairs can be given; the message names cause and way out.
    """
    stiffness, mass = (csr_array(matrix, dtype=np.float64, copy=True) for matrix in (stiffness, mass))
    if method not in METHODS:
        raise EigensolverError(f"method {method!r} is unknown, choose one of {', '.join(METHODS)}")
    if stiffness.shape != mass.shape or stiffness.shape[0] != stiffness.shape[1]:
        raise EigensolverError(
            f"stiffness is {stiffness.shape} and mass {mass.shape}, both must be square and of one size"
        )
    n = stiffness.shape[0]
    check_request(n, k, tolerance)
    check_pencil(stiffness, mass)
    if (method == "dense" and n > LARGEST_DENSE_SIZE) or (4 * k > n > LARGEST_DENSE_SIZE):
        raise EigensolverError(
            f"k = {k} of n = {n}: dense matrices end at n = {LARGEST_DENSE_SIZE}, take k <= {n // 4}"
        )
    if method not in ("auto", "dense") and 4 * k > n:
        raise EigensolverError(f"k = {k} is over a quarter of n = {n}: take k <= {n // 4} or method dense")
    if method == "lobpcg":
        return lobpcg(stiffness, mass, k, tolerance, seed)
    count, labels = component_labels(stiffness, mass)
    solve = partial(_connected, method=method, tolerance=tolerance, seed=seed, progress=progress, threads=threads)
    if count == 1:
        system = solve(stiffness, mass, k)
    else:
        size = LARGEST_DENSE_SIZE if method == "dense" else DENSE_SIZE
        system = solve_components(stiffness, mass, labels, k, solve, size, tolerance)
    return certified(system, k, tolerance)


def _connected(
    stiffness: csr_array,
    mass: csr_array,
    k: int,
    method: str,
    tolerance: float,
    seed: int,
    progress: Progress | None,
    threads: int,
) -> EigenSystem:
    """Solve a pencil that is connected; "auto" turns to dense algebra where slicing proves nothing."""
    n = stiffness.shape[0]
    if method == "dense" or (method == "auto" and n <= LARGEST_DENSE_SIZE and (n <= DENSE_SIZE or 4 * k > n)):
        return dense(stiffness, mass, k, tolerance)
    if method == "arpack":
        return arpack(stiffness, mass, k, tolerance, seed)
    try:
        return certified(slicing(stiffness, mass, k, tolerance, seed, progress, threads), k, tolerance)
    except EigensolverError:
        if method == "slicing" or n > LARGEST_DENSE_SIZE:
            raise
        return dense(stiffness, mass, k, tolerance)
