"""Errors of methods over that of a reference."""

from typing import Annotated

from pydantic import Field

from surfexp.contract.member import Member
from surfexp.contract.metric import Metric, MetricName
from surfexp.lab.registry.registry import register
from surfexp.statistics.statistic import Statistic
from surfexp.studies.smoothing.error_ratios import error_ratios
from surfexp.variational.solution import Solution

METRICS = {
    "units": Metric("units on which all methods were tried"),
    "groups": Metric("groups of units that are drawn together"),
    "ratio {method}": Metric("median of the error over that of the reference", better="lower"),
    "low {method}": Metric("lower end of its 95 % interval", better="lower"),
    "high {method}": Metric("upper end of its 95 % interval", better="lower"),
    "failed {method}": Metric("units without a converged result", better="lower"),
}


@register("statistic", "error_ratios", metrics=METRICS, defaults_of=error_ratios)
def error_ratios_statistic(
    solutions: dict[Member, Solution],
    *,
    error: Annotated[MetricName, Field(description="metric of the solutions that is an error")] = "rmse",
    reference: Annotated[str, Field(min_length=1, description="class to divide by")] = "heat flow",
    baseline: Annotated[str, Field(min_length=1, description="class that stands for doing nothing")] = "none",
    seed: Annotated[int, Field(ge=0, description="seed of the bootstrap")],
) -> Statistic:
    """Median ratio of each method's error to a reference's, with bootstrap intervals over groups of units."""
    return error_ratios(solutions, error, reference, baseline, seed)
