"""Segmentation into several regions."""

from pydantic import Field

from surfexp.variational.model import Model
from surfexp.variational.multiphase_model import MultiphaseSegmentation
from surfexp.workflow.registry import Options, register


class Multiphase(Options):
    """The number of regions, and the weight of the data."""

    regions: int = Field(3, ge=2, le=64, description="number of regions")
    smoothness: float = Field(0.3, gt=0, description="weight of the length of the boundaries, without unit")
    updates: int = Field(10, ge=1, le=1000, description="largest number of updates of the means")


@register("model", "multiphase")
def multiphase_model(options: Multiphase) -> Model:
    """Convex relaxation of the segmentation into k regions, grey or coloured, with updated means."""
    return MultiphaseSegmentation(**dict(options))
