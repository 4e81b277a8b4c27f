"""Laplace-Beltrami eigenpairs of surfaces: once, with factors kept, and in the form of scipy's `eigsh`."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csr_array, issparse

from surfexp.contract.arrays import Floats
from surfexp.mesh.given_numbers import given_threads, one_of, real_number, whole_number
from surfexp.mesh.surface import Surface
from surfexp.operators.elements_surface import Boundary, Mass
from surfexp.spectrum.eigensolver import eigenpairs as matrix_eigenpairs
from surfexp.spectrum.eigensolver_error import EigensolverError
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.hermitian import hermitian_pairs
from surfexp.spectrum.lowest_pairs import lowest_pairs
from surfexp.spectrum.single_slice import Progress
from surfexp.tasks.given_surface import SurfaceLike, as_surface
from surfexp.tasks.part_of_task import part_for

# largest residual that any request may have, and that of pairs which are right to rounding, over the norm of A
LOOSEST, ROUNDING = 1e-2, 1e-13


def eigenpairs(
    surface: SurfaceLike,
    count: int = 50,
    *,
    tolerance: float = 1e-8,
    mass: Mass = "consistent",
    boundary: Boundary = "neumann",
    progress: Progress | None = None,
    threads: int | None = None,
) -> EigenSystem:
    """Find the lowest eigenpairs of the Laplace-Beltrami operator, with the proof that none is missing.

    Parameters
    ----------
    surface : Surface, path, or (vertices, faces)
        Only the part inside its mask counts; `boundary` is the condition at the mask's boundary, too. Where slivers
        leave the pairs in doubt, the intrinsic Delaunay triangles of the same surface are taken, with a note.
    count : int
        How many, the zero mode of a closed surface among them.
    tolerance : float
        Largest relative residual.
    mass : "consistent" or "lumped"
    boundary : "neumann" or "dirichlet"
        At the boundary of the surface and that of its mask alike: natural, or 0 there.
    progress : callable, optional
        Receives the number of pairs found and the share that is missing.
    threads : int, optional
        For more than 200 pairs; all cores if not given. The result has the same bytes for any number of them.

    Returns
    -------
    EigenSystem
        `values` (count,) in 1 / unit^2; `vectors` (n, count), orthonormal for the mass, NaN outside the mask; `residuals`,
        `complete`, `inertia`.

    Raises
    ------
    ValueError
        If the mesh or a parameter is unfit.

    References
    ----------
    Reuter, Wolter, Peinecke: Laplace-Beltrami spectra as "Shape-DNA" of surfaces and solids (2006).

    Examples
    --------
    >>> import surfexp as sx
    >>> modes = sx.eigenpairs(sx.shape("icosphere", levels=3), 9)
    >>> modes.complete, (modes.values[[1, 4]] / [2, 6]).round(2).tolist()
    (True, [1.01, 1.01])
    """
    count = whole_number(count, "count", 1)
    tolerance = real_number(tolerance, "tolerance", above=0.0, below=1.0)
    one_of(mass, "mass", get_args(Mass))
    one_of(boundary, "boundary", get_args(Boundary))
    threads = given_threads(threads)
    owner = as_surface(surface)
    part = part_for(owner)
    cut = Surface(part.mesh, owner.name, owner.unit)
    _, system = lowest_pairs(
        cut, count, mass=mass, boundary=boundary, tolerance=tolerance, progress=progress, threads=threads
    )
    system = system.in_length(part.length)
    vectors = system.vectors if part.is_whole else part.extend(system.vectors)
    return replace(system, vectors=vectors, notes=part.notes + system.notes)


def eigsh(
    A: Any,
    k: int = 6,
    M: Any = None,
    sigma: float | None = None,
    which: str = "LM",
    v0: ArrayLike | None = None,
    ncv: int | None = None,
    maxiter: int | None = None,
    tol: float = 0,
    return_eigenvectors: bool = True,
    Minv: Any = None,
    OPinv: Any = None,
    mode: str = "normal",
    rng: Any = None,
    *,
    threads: int | None = None,
) -> Floats | tuple[Floats, Floats | NDArray[np.complex128]]:
    """Find the k lowest eigenpairs of A x = lambda M x, called as `scipy.sparse.linalg.eigsh` is, complete by inertia.

    For a positive semidefinite A, the values "nearest to a sigma at or below 0" are the smallest ones. This function finds
    those k values, and replaces scipy's call wherever they are requested.

    Parameters
    ----------
    A : (n, n) sparse
        Real symmetric or complex Hermitian, positive semidefinite.
    k : int
        How many pairs.
    M : (n, n) sparse, optional
        Real symmetric or complex Hermitian, positive definite; the identity if not given.
    sigma : float, optional
        At most 0; or not given, with which = "SM" or "SA".
    which : {"LM", "SM", "SA"}
        "LM" with a sigma, "SM" or "SA" without.
    v0 : (n,) float64, optional
    ncv, maxiter : int, optional
        Accepted and not needed.
    tol : float
        Largest relative residual; 0 means 1e-8, or rounding (1e-13 of the norm of A) where that is more.
    return_eigenvectors : bool
        False: the values alone.
    Minv, OPinv : sparse or LinearOperator, optional
        Accepted and not needed.
    mode : {"normal"}
    rng : numpy.random.Generator, optional
        Accepted and not needed.
    threads : int, optional
        For more than 200 pairs; all cores if not given. The result has the same bytes for any number of them.

    Returns
    -------
    (k,) float64, (n, k) float64
        Increasing values and M-orthonormal vectors, complex128 where a matrix is complex; the values alone without
        `return_eigenvectors`.

    Raises
    ------
    ValueError
        If another part of the spectrum is requested, a matrix is unfit, or the proof of completeness fails.

    Examples
    --------
    >>> import surfexp as sx
    >>> from scipy.sparse import diags_array
    >>> values, vectors = sx.eigsh(diags_array(np.arange(500.0)), k=3, sigma=-0.01)
    >>> values.round(6).tolist()
    [0.0, 1.0, 2.0]
    """
    _check_request(A, sigma, which, mode)
    n = A.shape[0]
    k, tol, threads = whole_number(k, "k", 1, n), real_number(tol, "tol"), given_threads(threads)
    shape = A.shape if M is None else _sparse(M, "M").shape
    if not A.shape == shape == (n, n):
        raise ValueError(f"A has shape {A.shape}, M {shape}: square matrices of one size are needed")
    mass = csr_array((np.ones(n), (np.arange(n),) * 2), shape=A.shape) if M is None else _sparse(M, "M")
    sizes = _largest_entry(A, "A"), _largest_entry(mass, "M")
    pencil = csr_array(A) / sizes[0], csr_array(mass) / sizes[1]
    values, vectors = _pencil_pairs(*pencil, k, tol, threads)
    # one factor after the other: their quotient may be beyond the largest number where the values are not
    values, vectors = values * sizes[0] / sizes[1], vectors / np.sqrt(sizes[1])
    if not np.isfinite(values).all():
        raise ValueError(
            f"A has entries up to {sizes[0]:.0e}, M up to {sizes[1]:.0e}: eigenvalues overflow, scale them"
        )
    return (values, vectors) if return_eigenvectors else values


def _pencil_pairs(
    a: csr_array, m: csr_array, k: int, tol: float, threads: int
) -> tuple[Floats, NDArray[np.float64] | NDArray[np.complex128]]:
    """Solve to the tolerance; where none is given and rounding forbids 1e-8, to what rounding allows.

    Values that are small beside the largest ones have few digits: no method knows them better than to rounding of A.
    """
    try:
        return _solved(a, m, k, tol or 1e-8, threads)
    except EigensolverError as error:
        problem = error
    if not tol:
        try:
            values, vectors = _solved(a, m, k, LOOSEST, threads)
        except EigensolverError as error:
            problem = error
        else:
            errors = np.linalg.norm(a @ vectors - (m @ vectors) * values, axis=0) / np.linalg.norm(vectors, axis=0)
            if errors.max() <= ROUNDING * float(abs(a).sum(axis=1).max()):
                return values, vectors
    # the way out that is told for surfaces is none for a pencil
    fact = str(problem).rpartition(": ")[0] or str(problem)
    raise EigensolverError(f"{fact}: A must be positive semidefinite, M definite and well scaled, or give a larger tol")


def _solved(
    a: csr_array, m: csr_array, k: int, tolerance: float, threads: int
) -> tuple[Floats, NDArray[np.float64] | NDArray[np.complex128]]:
    if any(np.iscomplexobj(matrix) for matrix in (a, m)):
        return hermitian_pairs(a, m, k, tolerance, threads)
    system = matrix_eigenpairs(a, m, k, tolerance=tolerance, threads=threads)
    return system.values, np.ascontiguousarray(system.vectors)


def _largest_entry(matrix: Any, name: str) -> float:
    """Return the largest modulus of an entry, 1 where all are 0."""
    largest = float(np.abs(csr_array(matrix).data).max(initial=0.0))
    if not np.isfinite(largest):
        raise ValueError(f"{name} has entries that are not finite: repair what it was assembled from")
    return largest or 1.0


def _sparse(matrix: Any, name: str) -> Any:
    if not issparse(matrix):
        raise ValueError(
            f"{name} is a {type(matrix).__name__}, a sparse matrix is needed, as scipy.sparse.csr_array({name}) of its entries"
        )
    return matrix


def _check_request(A: Any, sigma: float | None, which: str, mode: str) -> None:
    """Refuse what is not the lowest end of the spectrum of a sparse matrix."""
    lowest = (sigma is None and which in ("SM", "SA")) or (sigma is not None and sigma <= 0 and which == "LM")
    if not lowest or mode != "normal":
        asked = f"sigma = {sigma}, which = {which!r}, mode = {mode!r}"
        raise ValueError(
            f"{asked}: only the lowest pairs are found here; give sigma <= 0, or which = 'SM', mode = 'normal'"
        )
    _sparse(A, "A")
