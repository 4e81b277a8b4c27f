"""Whether two threads pay in the sweep that total variation solvers spend their time in."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from functools import partial

import numpy as np

from benchmarks.line import Line
from benchmarks.measurement import measure
from surfexp.mesh.torus import torus
from surfexp.operators.fem import fem
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.face_sweeps import dual_ascent, face_steps

SIZES = ((324, 81), (1580, 640))
SWEEPS = 50
NOTE = "solvers stay on one thread: Snakemake gives every core a stage of its own, and sums keep one order"


def warm_up() -> None:
    """Compile what the lines use."""
    _sweeps(fem(torus(20, 10).mesh), 1)


def lines(quick: bool) -> list[Line]:
    """Return a line for a mesh that fits into the cache and one that does not."""
    return [_line(*size) for size in (SIZES[:1] if quick else SIZES)]


def _line(rows: int, columns: int) -> Line:
    operator = fem(torus(rows, columns).mesh)
    one, cost = measure(partial(_sweeps, operator, 1))
    two, shared = measure(partial(_sweeps, operator, 2))
    difference = float(np.abs(one - two).max() / np.abs(one).max())
    ratio = cost.wall / shared.wall
    work = f"{SWEEPS} dual sweeps over {len(operator.faces):,} faces on two threads, a half of the faces each"
    accuracy = f"loads equal to {difference:.0e}; a load of its own for each thread, then their sum"
    met = ratio > 1.0 and difference < 1e-12
    return Line(work, "one thread, wall", "a figure", f"{ratio:.2f}×", met, shared, cost, accuracy, NOTE)


def _sweeps(operator: SurfaceOperator, threads: int) -> np.ndarray:
    """Return the load after some dual ascents towards a fixed function."""
    rng = np.random.default_rng(0)
    values, steps = rng.normal(size=(operator.vertex_count, 1)), face_steps(operator.hat_gradients)
    dual = np.zeros((len(operator.faces), 1, 2))
    loads = np.zeros((threads, operator.vertex_count, 1))
    halves = [slice(part[0], part[-1] + 1) for part in np.array_split(np.arange(len(operator.faces)), threads)]

    def ascend(k: int) -> None:
        some = halves[k]
        fields = operator.faces[some], operator.hat_gradients[some], operator.areas[some], steps[some]
        dual_ascent(*fields, 0.1, values, dual[some], loads[k])

    with ThreadPoolExecutor(threads) as pool:
        for _ in range(SWEEPS):
            if threads == 1:
                ascend(0)
            else:
                list(pool.map(ascend, range(threads)))
                loads[0] += loads[1]
    return np.asarray(loads[0])
