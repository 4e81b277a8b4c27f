"""Few and many eigenpairs, 50 and 1,000, against ARPACK with our Cholesky factors."""

from __future__ import annotations

from functools import partial

from scipy.sparse import csr_array
from scipy.sparse.linalg import LinearOperator, eigsh

from benchmarks.line import Line, race
from benchmarks.measurement import measure
from benchmarks.scenes import cortex_scene
from surfexp.linalg.factorisation import factorise
from surfexp.mesh.icosphere import icosphere
from surfexp.mesh.triangle_mesh import Floats, TriangleMesh
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.fem import fem
from surfexp.spectrum.eigensolver import eigenpairs
from surfexp.spectrum.eigensystem import measure as measure_vectors

RESIDUAL = 1e-8
# vertices, pairs, least ratio
RACES = ((39994, 50, 1.5), (10000, 1000, 7.0))


def warm_up() -> None:
    """Compile what the lines use."""
    eigenpairs(*_matrices(icosphere(3).mesh), 20, "slicing")


def lines(quick: bool) -> list[Line]:
    """Return a line for few pairs of a large mesh and one for many pairs of a smaller one."""
    return [_line(*which) for which in (((10000, 20, 1.5),) if quick else RACES)]


def _matrices(mesh: TriangleMesh) -> tuple[csr_array, csr_array]:
    operator = fem(mesh)
    return stiffness(operator), mass_matrix(operator)


def _line(size: int, count: int, least: float) -> Line:
    mesh = cortex_scene(size).surface.mesh
    matrices = _matrices(mesh)
    ours, cost = measure(partial(eigenpairs, *matrices, count, "slicing", RESIDUAL))
    vectors, their_cost = measure(partial(_arpack, *matrices, count))
    theirs = float(measure_vectors(*matrices, vectors).residuals.max())
    proved = "complete by inertia" if ours.complete else "not proved complete"
    accuracy = f"largest relative residual: ours {ours.residuals.max():.1e}, {proved}; rival {theirs:.1e}"
    fair = ours.complete and float(ours.residuals.max()) <= RESIDUAL
    work = f"first {count} eigenpairs, {len(mesh.vertices):,} V, residual {RESIDUAL:g}"
    return race(work, "scipy eigsh, shift-invert, cholespy factors", least, cost, their_cost, accuracy, fair=fair)


def _arpack(a: csr_array, b: csr_array, count: int) -> Floats:
    """Vectors with a basis of 2.2 k and the tolerance 1e-9, which reaches about the same residual."""
    shift = -0.01 / float(b.sum())
    inverse = LinearOperator(a.shape, matvec=factorise(csr_array(a - shift * b)).solve, dtype=float)
    _, vectors = eigsh(a, count, b, sigma=shift, OPinv=inverse, ncv=int(2.2 * count) + 20, tol=1e-9)
    return vectors.copy(order="F")
