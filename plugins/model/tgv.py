"""Denoising by total generalised variation of second order."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.variational.models.tgv import TGV
from surfexp.variational.truth_metrics import RESTORATION_METRICS

register(
    "model",
    "tgv",
    metrics=RESTORATION_METRICS,
    options={
        "weight": Field(gt=0, description="weight without unit, mu sigma h"),
        "mu": Field(gt=0, description="the weight itself in place of weight"),
        "ratio": Field(gt=0, description="length over which a slope may turn, in edge lengths"),
    },
)(TGV)
