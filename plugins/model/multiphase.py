"""Segmentation into several regions."""

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.variational.models.multiphase import MultiphaseSegmentation

METRICS = {
    "c{region}": Metric("mean of a region, first channel", "unit of the image"),
    "updates": Metric("updates of the means", better="lower"),
    "trivial_energy": Metric("energy of the best labelling with one region"),
    "labelling_energy": Metric("energy of the labelling"),
    "least_dice": Metric("least overlap of a reference region with its best region", better="higher"),
    "dice {reference}": Metric("overlap of a reference region with its best region, by area", better="higher"),
}


register(
    "model",
    "multiphase",
    metrics=METRICS,
    options={
        "regions": Field(ge=2, le=64, description="number of regions"),
        "smoothness": Field(gt=0, description="weight of the length of the boundaries, without unit"),
        "updates": Field(ge=1, le=1000, description="largest number of updates of the means"),
    },
)(MultiphaseSegmentation)
