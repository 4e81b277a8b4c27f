"""Certified gap against seconds on the cup: the picture behind the ratios of denoising."""

from __future__ import annotations

from functools import partial
from importlib.util import find_spec

import numpy as np

from audits.benchmarks.denoising import CHECKPOINTS, published, solve
from audits.benchmarks.interior_point import InteriorPoint
from audits.benchmarks.measurement import measure
from audits.benchmarks.scenes import cup_scene
from surfexp.contract.arrays import Floats
from surfexp.figures.cost_plot import cost_plot
from surfexp.figures.figure import Figure
from surfexp.operators.fem import fem
from surfexp.variational.models.rof import ROF
from surfexp.variational.solvers.newton import newton
from surfexp.variational.solvers.primal_dual import primal_dual

Points = list[tuple[float, float]]
PRIMAL_DUAL = tuple(10.0**-k for k in range(1, 7))
NEWTON = (1e-4, 1e-6, 1e-8, 1e-10)
CLARABEL = (1e-3, 1e-5, 1e-7, 1e-9)


def gap_curves(count: int = 25075) -> Figure:
    """Draw primal-dual, Newton, CLARABEL where it is installed, and split Bregman as published.

    All gaps are to lower bounds proved for the face-based energy, so they bound the excess of energy of each.
    """
    scene = cup_scene(count)
    curves: dict[str, Points] = {}
    for name, method, tolerances in (("primal-dual", primal_dual, PRIMAL_DUAL), ("Newton", newton, NEWTON)):
        runs = [solve(scene, partial(method, tolerance=tolerance)) for tolerance in tolerances]
        curves[name] = [(solution.relative_gap or 0.0, cost.cpu) for solution, cost in runs]
    if all(find_spec(package) for package in ("cvxpy", "clarabel")):
        operator = fem(scene.surface.mesh)
        problem = InteriorPoint(ROF().fidelity(scene.image, operator), operator)
        found = [measure(partial(problem.solve, tolerance), 1) for tolerance in CLARABEL]
        curves["CLARABEL"] = [(problem.relative_gap(result), cost.cpu) for result, cost in found]
    sweeps = [published(scene, iterations) for iterations in CHECKPOINTS]
    curves["as published"] = [(solution.relative_gap or 0.0, times[0]) for solution, times in sweeps]
    return cost_plot({name: _columns(points) for name, points in curves.items()}, title=f"ROF, {count:,} vertices")


def _columns(points: Points) -> tuple[Floats, Floats]:
    gaps, seconds = np.array(points).T
    return gaps, np.column_stack([seconds] * 3)
