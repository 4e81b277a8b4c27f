"""Eigenpairs against the hierarchical subspace iteration, and on two threads against one."""

from __future__ import annotations

from functools import partial

from audits.benchmarks.line import Line, race
from audits.benchmarks.measurement import measure, measure_both
from audits.benchmarks.scenes import cortex_scene
from audits.benchmarks.spectra import ours
from audits.benchmarks.subspace_iteration import hierarchical_subspace_iteration
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.fem import fem
from surfexp.spectrum.eigensolver import eigenpairs

RESIDUALS = (1e-2, 1e-6)
SIZE, COUNT = 39994, 300
LARGER = (1.5, 2.0)
TWO_THREADS = 1.7


def warm_up() -> None:
    """Compile what the lines use."""
    ball = icosphere(4).mesh
    operator = fem(ball)
    hierarchical_subspace_iteration(ball, stiffness(operator), mass_matrix(operator), 20, 1e-2)
    eigenpairs(stiffness(operator), mass_matrix(operator), 20, "slicing", 1e-6)


def lines(quick: bool) -> list[Line]:
    """Return a line for each residual, and those of two threads."""
    size, count = (10000, 40) if quick else (SIZE, COUNT)
    found = [_against_hierarchy(size, count, residual) for residual in RESIDUALS]
    return found if quick else [*found, *(_two_threads(size, COUNT) for size in (SIZE, 160000))]


def _against_hierarchy(size: int, count: int, residual: float) -> Line:
    mesh = cortex_scene(size).surface.mesh
    operator = fem(mesh)
    pencil = stiffness(operator), mass_matrix(operator)
    rivals = [partial(hierarchical_subspace_iteration, mesh, *pencil, count, residual, larger) for larger in LARGER]
    best = min(rivals, key=lambda rival: measure(rival, 1)[1].cpu)
    (found, cost), (theirs, their_cost) = measure_both(partial(eigenpairs, *pencil, count, "slicing", residual), best)
    values, _, iterations = theirs
    error = float((abs(values - found.values)[1:] / found.values[1:]).max())
    accuracy = (
        f"ours residual {found.residuals.max():.1e}, complete {found.complete}; rival {iterations} iterations on "
        f"the finest level, values within {error:.1e} of ours"
    )
    work = f"first {count} eigenpairs, {len(mesh.vertices):,} V, residual {residual:g}"
    better = " and ".join(f"{larger:g}" for larger in LARGER)
    note = f"matrices are there on both sides; the rival's block is the better of {better} times the pairs"
    return race(work, "hierarchical subspace iteration, written here", 1.0, cost, their_cost, accuracy, note=note)


def _two_threads(size: int, count: int) -> Line:
    mesh = cortex_scene(size).surface.mesh
    one, two = ours(mesh, count, 1, 1).cost, ours(mesh, count, 2, 1).cost
    ratio = one.wall / two.wall
    work = f"first {count} eigenpairs, {len(mesh.vertices):,} V, two threads, wall"
    told = f"two threads spend {two.cpu / two.wall:.2f} processor seconds a second: near 1, the second one is idle"
    return Line(work, "one thread", f"{TWO_THREADS:g}×", f"{ratio:.2f}×", ratio >= TWO_THREADS, two, one, told)
