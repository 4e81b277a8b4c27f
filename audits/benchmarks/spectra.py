"""One spectrum in a process of its own: by us, by LaPy with CHOLMOD, or by a tuned eigsh with CHOLMOD."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.linalg import LinearOperator, eigsh

from audits.benchmarks import THREADS
from audits.benchmarks.line import Line, not_installed
from audits.benchmarks.measurement import Cost, apart, measure_with_memory
from surfexp.contract.arrays import Floats
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.fem import fem
from surfexp.spectrum.eigensolver import eigenpairs
from surfexp.spectrum.eigensystem import measure as measure_vectors

RESIDUAL = 1e-8
ARPACK_TOLERANCES = (1e-3, 1e-5, 1e-7, 1e-9)
LAPY, TUNED = "LaPy with CHOLMOD", "eigsh with CHOLMOD, tuned"


@dataclass(frozen=True)
class Spectrum:
    """What one solver gave and took.

    Parameters
    ----------
    values : (k,) array
    residual : float
        Largest relative residual.
    complete : bool
        Whether no eigenvalue is proved to be missed.
    cost : Cost
    memory : float
        Bytes by which the peak resident memory of the process grew.
    """

    values: Floats
    residual: float
    complete: bool
    cost: Cost
    memory: float


def ours(mesh: TriangleMesh, count: int, threads: int = 1, runs: int = 3) -> Spectrum:
    """Return the spectrum by slicing."""
    return _apart(_slicing, mesh, count, threads, runs)


def lapy(mesh: TriangleMesh, count: int, threads: int = 1) -> Spectrum:
    """Return the spectrum by LaPy with its CHOLMOD switched on; it has no tolerance to set."""
    return _apart(_lapy, mesh, count, threads, 3)


def tuned(mesh: TriangleMesh, count: int) -> Spectrum:
    """Return the spectrum by ARPACK with a basis of 2.2 k, at the loosest tolerance that reaches the residual."""
    for tolerance in ARPACK_TOLERANCES:
        found = _apart(partial(_tuned, tolerance=tolerance), mesh, count, 1, 3)
        if found.residual <= RESIDUAL:
            break
    return found


def race(
    work: str, rival: str, least: float, one: Spectrum, other: Spectrum, *, wall: bool = False, memory: float = np.inf
) -> Line:
    """Return the line; it is met only where ours is complete, within the residual and `memory` times the rival's."""
    ratio = other.cost.wall / one.cost.wall if wall else other.cost.cpu / one.cost.cpu
    agree = float(np.abs(one.values[1:] - other.values[1:]).max() / one.values[-1])
    accuracy = f"{describe(one)}; rival {other.residual:.1e}, {_gigabytes(other)}; values agree to {agree:.0e}"
    fair = one.complete and one.residual <= RESIDUAL and agree < 1e-8 and one.memory <= memory * other.memory
    note = "ratio of wall seconds" if wall else ""
    return Line(
        work, rival, f"{least:g}×", f"{ratio:.1f}×", fair and ratio >= least, one.cost, other.cost, accuracy, note
    )


def describe(spectrum: Spectrum) -> str:
    """Return residual, completeness and memory in words."""
    proved = "complete by inertia" if spectrum.complete else "not proved complete"
    return f"largest relative residual {spectrum.residual:.1e}, {proved}, {_gigabytes(spectrum)}"


def has_cholmod() -> bool:
    """Return whether LaPy and scikit-sparse are there."""
    return all(find_spec(name) is not None for name in ("lapy", "sksparse"))


def without_cholmod(work: str, rival: str, least: float) -> Line:
    """Return the line of a rival that cannot be run; scikit-sparse needs the SuiteSparse library of the system."""
    return not_installed(work, rival, least, "lapy or scikit-sparse (which needs libsuitesparse-dev)")


def _gigabytes(spectrum: Spectrum) -> str:
    return f"{spectrum.memory / 2**30:.2f} GiB"


def _apart(
    solve: Callable[[TriangleMesh, int], tuple[Floats, Floats, bool]],
    mesh: TriangleMesh,
    count: int,
    threads: int,
    runs: int,
) -> Spectrum:
    os.environ[THREADS] = str(threads)
    try:
        return apart(_measured, solve, mesh, count, runs)
    finally:
        del os.environ[THREADS]


def _measured(
    solve: Callable[[TriangleMesh, int], tuple[Floats, Floats, bool]], mesh: TriangleMesh, count: int, runs: int
) -> Spectrum:
    solve(icosphere(3).mesh, 20)
    (values, vectors, complete), cost, memory = measure_with_memory(partial(solve, mesh, count), runs)
    residual = float(measure_vectors(*_matrices(mesh), np.asfortranarray(vectors)).residuals.max())
    return Spectrum(values, residual, complete, cost, memory)


def _matrices(mesh: TriangleMesh) -> tuple[csr_array, csr_array]:
    operator = fem(mesh)
    return stiffness(operator), mass_matrix(operator)


def _slicing(mesh: TriangleMesh, count: int) -> tuple[Floats, Floats, bool]:
    found = eigenpairs(*_matrices(mesh), count, "slicing", RESIDUAL, threads=int(os.environ.get(THREADS, "1")))
    return found.values, found.vectors, found.complete


def _lapy(mesh: TriangleMesh, count: int) -> tuple[Floats, Floats, bool]:
    from lapy import Solver, TriaMesh

    values, vectors = Solver(TriaMesh(mesh.vertices, mesh.faces), use_cholmod=True).eigs(count)
    return values, vectors, False


def _tuned(mesh: TriangleMesh, count: int, tolerance: float) -> tuple[Floats, Floats, bool]:
    from sksparse.cholmod import cholesky

    a, b = _matrices(mesh)
    shift = -0.01 * 4.0 * np.pi / float(b.sum())
    inverse = LinearOperator(a.shape, matvec=cholesky((a - shift * b).tocsc()), dtype=np.float64)
    start = np.random.default_rng(0).normal(size=a.shape[0])
    values, vectors = eigsh(a, count, b, sigma=shift, OPinv=inverse, v0=start, ncv=int(2.2 * count) + 20, tol=tolerance)
    return values, vectors, False
