"""Errors of methods over that of a reference."""

from typing import Annotated

from pydantic import Field

from surfexp.contract.metric import Metric, MetricName
from surfexp.lab.registry.registry import register
from surfexp_studies.smoothing.error_ratios import error_ratios

METRICS = {
    "units": Metric("units on which all methods were tried"),
    "groups": Metric("groups of units that are drawn together"),
    "ratio {method}": Metric("median of the error over that of the reference", better="lower"),
    "low {method}": Metric("lower end of its 95 % interval", better="lower"),
    "high {method}": Metric("upper end of its 95 % interval", better="lower"),
    "failed {method}": Metric("units without a converged result", better="lower"),
}


register(
    "statistic",
    "error_ratios",
    metrics=METRICS,
    options={
        "metric": Annotated[MetricName, Field("rmse", description="metric of the solutions that is an error")],
        "reference": Field("heat flow", min_length=1, description="class to divide by"),
        "baseline": Field("none", min_length=1, description="class that stands for doing nothing"),
        "seed": Field(ge=0, description="seed of the bootstrap"),
    },
    names={"metric": "error"},
)(error_ratios)
