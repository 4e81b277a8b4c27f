"""What a second thread brings to the primal-dual method."""

from __future__ import annotations

from functools import partial

import numpy as np

from audits.benchmarks.line import Line
from audits.benchmarks.measurement import measure_both
from audits.benchmarks.scenes import torus_scene
from surfexp.operators.fem import fem
from surfexp.variational.models.rof import ROF
from surfexp.variational.solvers.primal_dual import primal_dual

SIDES = (160, 1000)
ITERATIONS = 50
NOTE = "the workflow gives every core a stage of its own, so plugins take one thread"


def warm_up() -> None:
    """Compile what the lines use."""
    _line(20)


def lines(quick: bool) -> list[Line]:
    """Return a line for a mesh that fits into the cache and one that does not."""
    return [_line(side) for side in (SIDES[:1] if quick else SIDES)]


def _line(side: int) -> Line:
    scene = torus_scene(side)
    operator = fem(scene.surface.mesh)
    fidelity = ROF().fidelity(scene.image, operator)
    run = partial(primal_dual, fidelity, operator, tolerance=1e-12, iteration_limit=ITERATIONS)
    (two, shared), (one, cost) = measure_both(partial(run, threads=2), run)
    difference = float(np.abs(one.values - two.values).max() / 255.0)
    ratio = cost.wall / shared.wall
    work = f"primal-dual, {ITERATIONS} iterations, {operator.vertex_count:,} V, two threads"
    accuracy = f"values equal to {difference:.0e}; ratio of wall seconds"
    met = ratio > 1.0 and difference < 1e-10
    return Line(work, "one thread", "over 1×", f"{ratio:.2f}×", met, shared, cost, accuracy, NOTE)
