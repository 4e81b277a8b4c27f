"""The first 300 eigenpairs, against ARPACK with our Cholesky factors and against LaPy."""

from __future__ import annotations

from functools import cache, partial
from importlib.util import find_spec

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.linalg import LinearOperator, eigsh

from benchmarks.line import Line, not_installed, race
from benchmarks.measurement import Cost, measure
from benchmarks.scenes import cortex_scene
from surfexp.linalg.factorisation import factorise
from surfexp.mesh.icosphere import icosphere
from surfexp.mesh.triangle_mesh import Floats, TriangleMesh
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.fem import fem
from surfexp.spectrum.eigensolver import eigenpairs
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.eigensystem import measure as measure_vectors

RESIDUAL = 1e-8
ARPACK_TOLERANCES = (1e-6, 1e-8, 1e-10, 1e-12)


def warm_up() -> None:
    """Compile what the lines use."""
    eigenpairs(*_matrices(icosphere(3).mesh), 20, "slicing")


def lines(quick: bool) -> list[Line]:
    """Return two lines for each size, 10,000 and 39,994 vertices."""
    count = 40 if quick else 300
    return [line for size in ([10000] if quick else [10000, 39994]) for line in _lines(size, count)]


@cache
def eigensystem(size: int, count: int) -> tuple[EigenSystem, Cost]:
    """Return the first pairs of the folded cortex and their cost."""
    matrices = _matrices(cortex_scene(size).surface.mesh)
    return measure(partial(eigenpairs, *matrices, count, "slicing", RESIDUAL))


def _matrices(mesh: TriangleMesh) -> tuple[csr_array, csr_array]:
    operator = fem(mesh)
    return stiffness(operator), mass_matrix(operator)


def _lines(size: int, count: int) -> list[Line]:
    mesh = cortex_scene(size).surface.mesh
    matrices = _matrices(mesh)
    ours, cost = eigensystem(size, count)
    work = f"first {count} eigenpairs, {len(mesh.vertices):,} V, residual {RESIDUAL:g}"
    for tolerance in ARPACK_TOLERANCES:
        (values, vectors), their_cost = measure(partial(_arpack, *matrices, count, tolerance))
        if _residual(matrices, vectors) <= RESIDUAL:
            break
    proved = f"ours {ours.residuals.max():.1e}, {'complete by inertia' if ours.complete else 'not proved complete'}"
    theirs = f"rival {_residual(matrices, vectors):.1e} with its tolerance {tolerance:g}"
    agree = float(np.abs(values[1:] - ours.values[1:]).max() / ours.values[-1])
    accuracy = f"largest relative residual: {proved}; {theirs}; values agree to {agree:.0e}"
    fair = ours.complete and ours.residuals.max() <= RESIDUAL
    rival = "scipy eigsh, shift-invert, cholespy factors"
    return [race(work, rival, 7, cost, their_cost, accuracy, fair=fair), _lapy(work, mesh, matrices, count, ours, cost)]


def _arpack(a: csr_array, b: csr_array, count: int, tolerance: float) -> tuple[Floats, Floats]:
    shift = -0.01 * 4.0 * np.pi / float(b.sum())
    factors = factorise(csr_array(a - shift * b))
    inverse = LinearOperator(a.shape, matvec=factors.solve, dtype=np.float64)
    start = np.random.default_rng(0).normal(size=a.shape[0])
    values, vectors = eigsh(a, count, b, sigma=shift, OPinv=inverse, v0=start, tol=tolerance)
    order = np.argsort(values)
    return values[order], vectors[:, order]


def _residual(matrices: tuple[csr_array, csr_array], vectors: Floats) -> float:
    return float(measure_vectors(*matrices, np.asfortranarray(vectors)).residuals.max())


def _lapy(
    work: str, mesh: TriangleMesh, matrices: tuple[csr_array, csr_array], count: int, ours: EigenSystem, cost: Cost
) -> Line:
    rival = "LaPy with CHOLMOD"
    if find_spec("lapy") is None:
        return not_installed(work, rival, 7, "lapy")
    from lapy import Solver, TriaMesh

    cholmod = find_spec("sksparse") is not None
    surface = TriaMesh(mesh.vertices, mesh.faces)
    (_, vectors), their_cost = measure(lambda: Solver(surface, use_cholmod=cholmod).eigs(count))
    accuracy = f"largest relative residual: ours {ours.residuals.max():.1e}, rival {_residual(matrices, vectors):.1e}"
    if cholmod:
        return race(work, rival, 7, cost, their_cost, accuracy, fair=ours.complete)
    ratio = their_cost.cpu / cost.cpu
    result = f"not installed: scikit-sparse (LaPy with SuperLU: {ratio:.1f}×)"
    return Line(work, rival, "7×", result, False, cost, their_cost, accuracy, "seconds of the rival are with SuperLU")
