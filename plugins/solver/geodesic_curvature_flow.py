"""Geodesic curvature flow of level lines."""

from dataclasses import replace
from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.operators.calculus import total_variation
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.level_sets import perimeters
from surfexp.variational.solution import Solution
from surfexp.variational.surface_flows import geodesic_curvature_flow

METRICS = {
    "time": Metric("end time", "unit of length squared"),
    "length_before": Metric("length of the curve at the start", "unit of length"),
    "perimeter": Metric("length of the curve at the end", "unit of length"),
    "edge_length": Metric("mean length of the edges", "unit of length"),
}


@register("solver", "geodesic_curvature_flow", metrics=METRICS, defaults_of=geodesic_curvature_flow)
def geodesic_curvature_flow_solver(
    image: Image,
    operator: SurfaceOperator,
    *,
    time: Annotated[float, Field(gt=0, description="time of the flow, squared unit of length")] = 0.4,
    steps: Annotated[int, Field(ge=1, le=10000, description="semi-implicit steps")],
    smoothing: Annotated[float, Field(gt=0, le=1, description="regularisation of |grad f| as a share of its mean")],
) -> Solution:
    """Every level line of the image moves by its geodesic curvature; the length of the zero line before and after."""
    values = geodesic_curvature_flow(operator, image.values, time=time, steps=steps, smoothing=smoothing)
    zero = np.zeros(1)
    before, after = (float(perimeters(operator, field, zero)[0]) for field in (image.values, values))
    energy = total_variation(operator, values)
    solution = Solution(values, energy, iterations=steps, reason="end time", segmentation=(values > 0) * 1.0)
    metrics = {"time": time, "length_before": before, "perimeter": after, "edge_length": operator.edge_length}
    return replace(solution, model="geodesic curvature flow", solver="semi-implicit", metrics=metrics)
