"""Segmentation into several regions."""

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.variational.model import Model
from surfexp.variational.models.multiphase import MultiphaseSegmentation


class Multiphase(Options):
    """The number of regions, and the weight of the data."""

    regions: int = Field(3, ge=2, le=64, description="number of regions")
    smoothness: float = Field(0.3, gt=0, description="weight of the length of the boundaries, without unit")
    updates: int = Field(10, ge=1, le=1000, description="largest number of updates of the means")


METRICS = {
    "c{region}": Metric("mean of a region, first channel", "unit of the image"),
    "updates": Metric("updates of the means", better="lower"),
    "trivial_energy": Metric("energy of the best labelling with one region"),
    "labelling_energy": Metric("energy of the labelling"),
    "least_dice": Metric("least overlap of a reference region with its best region", better="higher"),
    "dice {reference}": Metric("overlap of a reference region with its best region, by area", better="higher"),
}


@register("model", "multiphase", metrics=METRICS)
def multiphase_model(options: Multiphase) -> Model:
    """Convex relaxation of the segmentation into k regions, grey or coloured, with updated means."""
    return MultiphaseSegmentation(**dict(options))
