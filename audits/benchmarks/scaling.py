"""Cost and memory of ROF against the number of vertices, at fixed iterations."""

from __future__ import annotations

from functools import partial

import numpy as np

from audits.benchmarks.line import Line
from audits.benchmarks.measurement import Cost, apart, measure_with_memory
from surfexp.mesh.shapes.torus import periodic_grid_faces, torus_points
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import fem
from surfexp.variational.separable_quadratic import rof
from surfexp.variational.solvers.primal_dual import primal_dual

SIZES = ((158, 64), (316, 128), (632, 256), (1264, 512), (1580, 640))
ITERATIONS = 100


def warm_up() -> None:
    """Compile what the line uses."""
    _solve(40, 16)


def lines(quick: bool) -> list[Line]:
    """Return the line of exponent and memory; every size runs in a process of its own, whose peak memory is read."""
    sizes = SIZES[:2] if quick else SIZES
    counts = np.array([rows * columns for rows, columns in sizes])
    costs, peaks = zip(*(apart(_cost_and_memory, *size) for size in sizes), strict=True)
    seconds = np.array([cost.cpu for cost in costs])
    exponent = float(np.polyfit(np.log(counts), np.log(seconds), 1)[0])
    memory = peaks[-1] / counts[-1]
    rates = ", ".join(f"{n:,} V {t:.2f} s" for n, t in zip(counts, seconds, strict=True))
    work = f"ROF, {ITERATIONS} iterations, {counts[0]:,} to {counts[-1]:,} V, with its operator"
    result = f"exponent {exponent:.2f}, {memory:,.0f} bytes a vertex"
    met = exponent <= 1.15 and memory < 1200
    return [
        Line(
            *(
                work,
                "straight line through the origin",
                "exponent at most 1.15, under 1,200 bytes a vertex",
                result,
                met,
            ),
            ours=costs[-1],
            accuracy=rates,
            note="bytes: growth of the peak resident memory, mesh and image included, at the largest size",
        )
    ]


def _cost_and_memory(rows: int, columns: int) -> tuple[Cost, float]:
    _solve(40, 16)
    return measure_with_memory(partial(_solve, rows, columns))[1:]


def _solve(rows: int, columns: int) -> None:
    u, v = (
        angle.ravel()
        for angle in np.meshgrid(
            *(np.linspace(0.0, 2.0 * np.pi, n, endpoint=False) for n in (rows, columns)), indexing="ij"
        )
    )
    mesh = TriangleMesh(torus_points(u, v, 1.0, 0.4), periodic_grid_faces(rows, columns))
    image = 255.0 * (np.sin(3.0 * u) * np.cos(v) > 0.0) + np.random.default_rng(0).normal(0.0, 40.0, len(u))
    operator = fem(mesh)
    fidelity = rof(operator.mass, image, 0.9 / (40.0 * operator.edge_length))
    primal_dual(fidelity, operator, tolerance=-1.0, iteration_limit=ITERATIONS)
