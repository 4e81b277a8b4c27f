"""Few and many eigenpairs, 50 and 1,000, and 50 of a million vertices."""

from __future__ import annotations

from audits.benchmarks.line import Line
from audits.benchmarks.scenes import cortex_scene
from audits.benchmarks.spectra import (
    LAPY,
    RESIDUAL,
    TUNED,
    describe,
    has_cholmod,
    lapy,
    ours,
    race,
    tuned,
    without_cholmod,
)
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.torus import torus

# vertices, pairs, least ratio to LaPy, least ratio to the tuned eigsh
RACES = ((39994, 50, 4.0, 1.5), (160000, 50, 4.0, 1.5), (39994, 1000, 25.0, None))
MILLION, MEMORY, SECONDS = (1600, 625), 2.5, 20.0


def warm_up() -> None:
    """Compile what the lines use."""
    ours(icosphere(3).mesh, 20)


def lines(quick: bool) -> list[Line]:
    """Return the races and the line of a million vertices."""
    if quick:
        return _lines(10000, 20, 2.5, 1.5)
    return [*(line for which in RACES for line in _lines(*which)), _large(*MILLION)]


def _lines(size: int, count: int, least: float, least_tuned: float | None) -> list[Line]:
    mesh = cortex_scene(size).surface.mesh
    work = f"first {count} eigenpairs, {len(mesh.vertices):,} V, residual {RESIDUAL:g}"
    rivals = [(LAPY, least, lapy)] + ([] if least_tuned is None else [(TUNED, least_tuned, tuned)])
    if not has_cholmod():
        return [without_cholmod(work, rival, ratio) for rival, ratio, _ in rivals]
    lines = []
    for rival, ratio, solve in rivals:
        theirs = solve(mesh, count)
        lines.append(race(work, rival, ratio, ours(mesh, count, runs=theirs.cost.runs), theirs))
    return lines


def _large(rows: int, columns: int) -> Line:
    mesh = torus(rows, columns).mesh
    found = ours(mesh, 50, runs=1)
    gigabytes = found.memory / 2**30
    met = gigabytes <= MEMORY and found.cost.cpu <= SECONDS and found.complete and found.residual <= RESIDUAL
    work, wanted = f"first 50 eigenpairs, torus of {len(mesh.vertices):,} V", f"≤ {SECONDS:g} s, ≤ {MEMORY:g} GiB"
    return Line(
        work,
        "a limit",
        wanted,
        f"{found.cost.cpu:.3g} s, {gigabytes:.2f} GiB",
        met,
        found.cost,
        accuracy=describe(found),
    )
