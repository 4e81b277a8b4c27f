"""Seconds of each filter of the smoothing race on one map of a cortex, with all that it prepares but for modes."""

from __future__ import annotations

from functools import partial

import numpy as np

import surfexp as sx
from audits.benchmarks.line import Line, within
from audits.benchmarks.measurement import measure
from surfexp.anatomy.fsaverage5 import fsaverage5
from surfexp.contract.arrays import Floats
from surfexp.mesh.masked_surface import cut_to_mask
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface
from surfexp.operators.fem import fem
from surfexp.smoothing.methods import MethodName, Methods
from surfexp.spectrum.eigensystem import EigenSystem

MODES, MODES_QUICK = 200, 20
# a parameter in the middle of each grid, and what a map may take at most in seconds
FILTERS: tuple[tuple[MethodName, float, float], ...] = (
    ("neighbour_mean", 16.0, 0.05),
    ("geodesic_gaussian", 6.0, 5.0),
    ("heat_flow", 6.0, 0.2),
    ("heat_polynomial", 6.0, 0.2),
    ("truncated_modes", float(MODES), 0.05),
    ("total_variation", 1.0, 0.5),
    ("edge_weighted_variation", 1.0, 0.5),
    ("generalised_variation", 1.0, 5.0),
)
AUTOMATIC = 10.0


def warm_up() -> None:
    """Compile what the lines use."""
    ball = icosphere(3)
    values = np.random.default_rng(0).standard_normal(len(ball.mesh.vertices))
    for name, parameter, _ in FILTERS:
        _filtered(ball, values, sx.eigenpairs(ball, MODES), name, parameter)
    sx.denoise(ball, values, method="auto")


def lines(quick: bool) -> list[Line]:
    """Return a line for each filter, and one for the choice among three."""
    whole = fsaverage5("left", "white")
    surface = cut_to_mask(whole, whole.scalars["thickness"] > 0)
    thickness = surface.scalars["thickness"]
    values = thickness + thickness.std() * np.random.default_rng(0).standard_normal(len(thickness))
    modes = sx.eigenpairs(surface, MODES_QUICK if quick else MODES)
    found = [_line(surface, values, modes, *row) for row in FILTERS]
    automatic = partial(sx.denoise, surface, values, method="auto")
    chosen, cost = measure(automatic, 1 if quick else 3)
    told = f"{str(chosen.certificate['chosen']).replace('_', ' ')} chosen by Stein's estimate"
    return [*found, within(f"the best of three filters, {len(values):,} V", AUTOMATIC, cost, told, fair=True)]


def _line(
    surface: Surface, values: Floats, modes: EigenSystem, name: MethodName, parameter: float, limit: float
) -> Line:
    methods, cost = measure(partial(_filtered, surface, values, modes, name, parameter))
    told = f"parameter {parameter:g}" + (f", gap {methods.largest_gap:.1e}" if methods.largest_gap else "")
    work = f"{name.replace('_', ' ')}, {len(values):,} V"
    return within(work, limit, cost, told, fair=methods.all_converged)


def _filtered(surface: Surface, values: Floats, modes: EigenSystem, name: MethodName, parameter: float) -> Methods:
    operator = fem(surface.mesh)
    methods = Methods(surface.mesh, operator, float(values.std()) / 2.0, modes)
    methods.smoother(name)[0](values[:, None], parameter)
    return methods
