"""Total variation deblurring (2.7)."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.variational.models.deblurring import Deblurring
from surfexp.variational.truth_metrics import RESTORATION_METRICS

register(
    "model",
    "deblurring",
    metrics=RESTORATION_METRICS,
    options={
        "width": Field(gt=0, le=100, description="standard deviation of the blur in edge lengths"),
        "weight": Field(gt=0, description="weight without unit, mu sigma h"),
        "mu": Field(gt=0, description="the published weight in place of weight; needed without noise"),
    },
)(Deblurring)
