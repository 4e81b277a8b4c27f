"""The energy by which two-phase segmentations of any method compare."""

from dataclasses import replace

import numpy as np
from pydantic import Field

from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.solution import Solution
from surfexp.workflow.registry import Options, register


class PartitionEnergy(Options):
    mu: float = Field(1e-3, gt=0, description="the printed weight of the data term, as in the solver compared")


@register("solver", "partition_energy")
def partition_energy(
    options: PartitionEnergy, *, result: Solution, image: Image, operator: SurfaceOperator
) -> Solution:
    """Another method's regions as they are, with boundary length + mu times the squared distance from the two means."""
    if result.segmentation is None or "perimeter" not in result.metrics:
        raise ValueError(f"{result.model} has no regions with a boundary; take a two-phase segmentation")
    inside = result.segmentation > 0.5
    misfit = 0.0
    for part in (inside, ~inside):
        weights = operator.mass * part
        mean = float(weights @ image.values / weights.sum()) if weights.any() else 0.0
        misfit += float(weights @ (image.values - mean) ** 2)
    energy = result.metrics["perimeter"] + options.mu * misfit
    metrics = {"partition_energy": energy, "inside_share": float(operator.mass @ inside / np.sum(operator.mass))}
    return replace(result, metrics=result.metrics | metrics)
