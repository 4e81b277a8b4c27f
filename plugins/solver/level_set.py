"""The implicit baseline of its time: projected gradient descent on a grid around the surface."""

from dataclasses import replace
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from surfexp.baselines.level_set import level_set
from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.mesh.surface import Surface
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.model import Model
from surfexp.variational.solution import Solution

METRICS = {
    "node_count": Metric("nodes of the band"),
    "grid_points": Metric("points of the whole grid"),
    "memory_bytes": Metric("memory of the band", "bytes", "lower"),
    "band_energy": Metric("energy in the band"),
    "band_gap": Metric("relative gap of the problem in the band", better="lower"),
    "normal_variation": Metric("variation of the result along the normals", "unit of the image", "lower"),
}


@register("solver", "level_set", metrics=METRICS, accepts={"model": ("rof", "convex_chan_vese")}, defaults_of=level_set)
def level_set_solver(
    surface: Surface,
    image: Image,
    operator: SurfaceOperator,
    model: Model,
    *,
    points: Annotated[
        int, Field(ge=16, le=2048, description="grid points along the longest side of the surface")
    ] = 162,
    degree: Annotated[
        Literal[1, 3], Field(description="degree of the interpolation that extends data off the surface")
    ],
    tolerance: Annotated[
        float, Field(gt=0, lt=1, description="relative fall of the energy between extensions at which to stop")
    ] = 0.001,
    step_limit: Annotated[int, Field(ge=1, description="most steps of one convex problem")] = 20000,
) -> Solution:
    """Projected gradient descent in a narrow band of a signed distance grid, data extended off the surface."""
    spacing = float(np.ptp(surface.mesh.vertices, axis=0).max()) / points
    limits = {"tolerance": tolerance, "step_limit": step_limit}
    method = replace(level_set(surface.mesh, spacing, degree), **limits, progress=report_progress)
    return model.run(image, operator, method)
