"""The energy by which two-phase segmentations of any method compare."""

from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.statistics.measurement import Measurement
from surfexp.variational.image import Image
from surfexp.variational.level_sets import perimeters
from surfexp.variational.solution import Solution

METRICS = {
    "partition_energy": Metric("perimeter and data term of the region"),
    "inside_share": Metric("share of the area inside"),
    "perimeter": Metric("length of the boundary of the region", "unit of length"),
}


@register("measurement", "partition_energy", metrics=METRICS)
def partition_energy(
    solver: Solution,
    image: Image,
    operator: SurfaceOperator,
    *,
    mu: Annotated[
        float, Field(gt=0, description="the published weight of the data term, as in the solver compared")
    ] = 0.001,
) -> Measurement:
    """Boundary length between the vertices of any method's regions + mu times the squared misfit."""
    if solver.segmentation is None or not np.isin(solver.segmentation, (0.0, 1.0)).all():
        raise ValueError(f"{solver.model} has not two regions; take a two-phase segmentation")
    inside = solver.segmentation > 0.5
    perimeter = float(perimeters(operator, inside.astype(np.float64), np.array([0.5]))[0])
    misfit = 0.0
    for part in (inside, ~inside):
        weights = operator.mass * part
        mean = float(weights @ image.values / weights.sum()) if weights.any() else 0.0
        misfit += float(weights @ (image.values - mean) ** 2)
    energy = perimeter + mu * misfit
    share = float(operator.mass @ inside / np.sum(operator.mass))
    metrics = {"partition_energy": energy, "inside_share": share, "perimeter": perimeter}
    return Measurement(solver.solver, solver.metrics | metrics, solver.notes)
