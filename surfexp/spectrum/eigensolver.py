"""The first k eigenpairs of a surface: one entrance, four methods, one kind of result."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array, sparray

from surfexp.spectrum.arpack import arpack
from surfexp.spectrum.dense import dense
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.lobpcg import lobpcg
from surfexp.spectrum.slicing import Progress, slicing

METHODS = ("auto", "slicing", "arpack", "lobpcg", "dense")
DENSE_SIZE = 400
LARGEST_DENSE_SIZE = 6000


def eigenpairs(
    stiffness: sparray,
    mass: sparray,
    k: int,
    method: str = "auto",
    tolerance: float = 1e-8,
    seed: int = 0,
    progress: Progress | None = None,
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

    Raises
    ------
    ValueError
        If k, the method, the tolerance or a matrix is unfit.
    """
    stiffness, mass = csr_array(stiffness, dtype=np.float64), csr_array(mass, dtype=np.float64)
    _check(stiffness, mass, k, method, tolerance)
    n = stiffness.shape[0]
    if method == "auto":
        method = "dense" if n <= DENSE_SIZE or 4 * k > n else "slicing"
    if method == "dense" and n > LARGEST_DENSE_SIZE:
        raise ValueError(f"k = {k} of n = {n}: dense matrices end at n = {LARGEST_DENSE_SIZE}, take k <= {n // 4}")
    if method == "dense":
        return dense(stiffness, mass, k)
    if 4 * k > n:
        raise ValueError(f"k = {k} is over a quarter of n = {n}: take k <= {n // 4} or method dense")
    if method == "arpack":
        return arpack(stiffness, mass, k, tolerance, seed)
    if method == "lobpcg":
        return lobpcg(stiffness, mass, k, tolerance, seed)
    return slicing(stiffness, mass, k, tolerance, seed, progress)


def _check(stiffness: csr_array, mass: csr_array, k: int, method: str, tolerance: float) -> None:
    if method not in METHODS:
        raise ValueError(f"method {method!r} is unknown, choose one of {', '.join(METHODS)}")
    if stiffness.shape != mass.shape or stiffness.shape[0] != stiffness.shape[1]:
        raise ValueError(f"stiffness is {stiffness.shape} and mass {mass.shape}, both must be square and of one size")
    n = stiffness.shape[0]
    if n < 3:
        raise ValueError(f"the surface has {n} degrees of freedom, an eigenproblem needs at least 3")
    if not 1 <= k <= n:
        raise ValueError(f"k = {k} eigenpairs of {n} degrees of freedom: take 1 <= k <= {n}")
    if not 1e-12 <= tolerance <= 1e-2:
        raise ValueError(f"tolerance = {tolerance:g}, take one between 1e-12 and 1e-2")
    for name, matrix in (("stiffness", stiffness), ("mass", mass)):
        bad = int((~np.isfinite(matrix.data)).sum())
        if bad:
            raise ValueError(f"the {name} matrix has {bad} entries that are not finite: repair the mesh")
        skew = float(np.abs((matrix - matrix.T).data).max(initial=0.0))
        if skew > 1e-10 * float(np.abs(matrix.data).max(initial=1.0)):
            raise ValueError(f"the {name} matrix is not symmetric, by {skew:.1e}")
    diagonal = mass.diagonal()
    if diagonal.min() <= 0:
        at = int(diagonal.argmin())
        raise ValueError(f"the mass of degree of freedom {at} is {diagonal[at]:g}, must be positive: repair the mesh")
