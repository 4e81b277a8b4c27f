"""The first 300 eigenpairs of folded cortices, against LaPy with CHOLMOD, on one thread and on two."""

from __future__ import annotations

from audits.benchmarks.line import Line
from audits.benchmarks.scenes import cortex_scene
from audits.benchmarks.spectra import LAPY, RESIDUAL, has_cholmod, lapy, ours, race, without_cholmod
from surfexp.mesh.shapes.icosphere import icosphere

COUNT = 300
SIZES = (10000, 39994, 160000)
TWO_THREADS = 39994
# most memory against the rival's
MEMORY = 1.2


def warm_up() -> None:
    """Compile what the lines use, in the process that will have it from the cache on disk."""
    ours(icosphere(3).mesh, 20)


def lines(quick: bool) -> list[Line]:
    """Return a line for each size on one thread, and the middle one on two."""
    if quick:
        return [_line(10000, 40, 1, 15.0)]
    return [*(_line(size, COUNT, 1, 15.0) for size in SIZES), _line(TWO_THREADS, COUNT, 2, 6.0)]


def _line(size: int, count: int, threads: int, least: float) -> Line:
    mesh = cortex_scene(size).surface.mesh
    on = "" if threads == 1 else f", {threads} threads, wall"
    work = f"first {count} eigenpairs, {len(mesh.vertices):,} V, residual {RESIDUAL:g}{on}"
    if not has_cholmod():
        return without_cholmod(work, LAPY, least)
    theirs = lapy(mesh, count, threads)
    found = ours(mesh, count, threads, theirs.cost.runs)
    return race(work, LAPY, least, found, theirs, wall=threads > 1, memory=MEMORY)
