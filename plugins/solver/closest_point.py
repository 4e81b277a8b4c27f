"""The implicit baseline of today: a primal-dual iteration on the closest-point extension."""

from dataclasses import replace
from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.baselines.closest_point import closest_point
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


@register("solver", "closest_point", metrics=METRICS, accepts={"model": ("rof", "convex_chan_vese")})
def closest_point_solver(
    surface: Surface,
    image: Image,
    operator: SurfaceOperator,
    model: Model,
    *,
    points: Annotated[
        int, Field(ge=16, le=2048, description="grid points along the longest side of the surface")
    ] = 162,
    tolerance: Annotated[float, Field(gt=0, lt=1, description="bound of the relative gap on the band")] = 0.0001,
    iteration_limit: Annotated[int, Field(ge=1, description="most iterations of one convex problem")] = 20000,
) -> Solution:
    """Primal-dual steps in a narrow band of closest points, so that nobody can call the comparison unfair."""
    spacing = float(np.ptp(surface.mesh.vertices, axis=0).max()) / points
    limits = {"tolerance": tolerance, "iteration_limit": iteration_limit}
    method = replace(closest_point(surface.mesh, spacing), **limits, progress=report_progress)
    return model.run(image, operator, method)
