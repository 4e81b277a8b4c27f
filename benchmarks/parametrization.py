"""Convex Chan-Vese on the folded cortex M2, end to end: intrinsic, conformal and level-set methods (table 2.2)."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from benchmarks.line import Line, race
from benchmarks.measurement import measure
from benchmarks.scenes import Scene, cortex_scene
from surfexp.baselines.conformal_flow import conformal_flow
from surfexp.baselines.energy_excess import energy_excess
from surfexp.baselines.level_set import level_set
from surfexp.baselines.parameter_domain import Parametrized, conformal_domain
from surfexp.baselines.spherical_map import spherical_map
from surfexp.operators.fem import fem
from surfexp.variational.convex_chan_vese_model import ConvexChanVese
from surfexp.variational.primal_dual import primal_dual
from surfexp.variational.solution import Solution

GRID_POINTS = 162
SOLVE = partial(primal_dual, tolerance=1e-4)


def warm_up() -> None:
    """Compile what the lines use."""
    scene = cortex_scene(10000)
    _intrinsic(scene)
    _conformal(scene, flow_steps=1)
    _level_set(scene, points=24, steps=2)


def lines(quick: bool) -> list[Line]:
    """Return the lines of the linear conformal map, of the conformal flow and of the level-set method."""
    scene = cortex_scene(10000 if quick else 39994)
    points, steps = (48, 20) if quick else (GRID_POINTS, 1000)
    ours, cost = measure(lambda: _intrinsic(scene))
    excess = _excess(scene, ours)
    rivals = [
        ("conformal: linear map, then the same solver on the sphere", 4.0, lambda: _conformal(scene, 0)),
        ("conformal: mean curvature flow, then the same solver", 4.0, lambda: _conformal(scene, 100)),
        (f"level set, {points} grid points, projected gradients", 40.0, lambda: _level_set(scene, points, steps)),
    ]
    found = []
    for name, least, work in rivals:
        theirs, their_cost = measure(work)
        accuracy = f"energy excess ours {excess:.1e} (tolerance 1e-4), rival {_excess(scene, theirs):.1e}"
        late = "" if theirs.converged else f"rival stopped unconverged ({theirs.reason}): a lower bound of its time"
        label = f"CCV on M2, {len(scene.surface.mesh.vertices):,} V, end to end"
        found.append(race(label, name, least, cost, their_cost, accuracy, fair=excess <= 1e-4, note=late))
    return found


def _intrinsic(scene: Scene) -> Solution:
    return ConvexChanVese().run(scene.image, fem(scene.surface.mesh), SOLVE)


def _conformal(scene: Scene, flow_steps: int) -> Solution:
    mesh = scene.surface.mesh
    positions = spherical_map(mesh)
    if flow_steps:
        positions = conformal_flow(mesh, positions, step_limit=flow_steps)
    method = Parametrized(conformal_domain(mesh, positions), SOLVE)
    return ConvexChanVese().run(scene.image, fem(mesh), method)


def _level_set(scene: Scene, points: int, steps: int) -> Solution:
    mesh = scene.surface.mesh
    spacing = float(np.ptp(mesh.vertices, axis=0).max()) / points
    method = replace(level_set(mesh, spacing), tolerance=1e-3, step_limit=steps)
    return ConvexChanVese().run(scene.image, fem(mesh), method)


def _excess(scene: Scene, solution: Solution) -> float:
    """Energy above a bound that the intrinsic solver proves to 1e-6 for the same two means."""
    operator = fem(scene.surface.mesh)
    fidelity, _ = ConvexChanVese().fidelity(scene.image, operator, (solution.metrics["c1"], solution.metrics["c2"]))
    bound = primal_dual(fidelity, operator, tolerance=1e-6).lower_bound
    assert bound is not None
    return energy_excess(fidelity, operator, solution.values, bound)
