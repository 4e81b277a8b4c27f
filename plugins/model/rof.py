"""Total variation denoising (2.6)."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.variational.models.rof import ROF
from surfexp.variational.truth_metrics import RESTORATION_METRICS

register(
    "model",
    "rof",
    metrics=RESTORATION_METRICS,
    options={
        "weight": Field(gt=0, description="weight without unit, mu sigma h"),
        "mu": Field(gt=0, description="the published weight in place of weight"),
    },
)(ROF)
