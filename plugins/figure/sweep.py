"""A metric against an option, a line for each method."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from surfexp.contract.member import Member, levels_of
from surfexp.contract.metric import MetricName
from surfexp.figures.figure import Figure
from surfexp.figures.sweep_plot import sweep_plot
from surfexp.lab.registry.registry import register
from surfexp.variational.solution import Solution


@register("figure", "sweep", defaults_of=sweep_plot)
def sweep_figure(
    solvers: dict[Member, Solution],
    *,
    metric: Annotated[MetricName, Field(description="metric of the solutions that is drawn")],
    x_label: Annotated[str, Field(description="what the levels of the members are")],
    y_label: Annotated[str, Field(description="default: the metric")] = "",
    log: Annotated[Literal["", "x", "y", "xy"], Field(description="logarithmic axes")],
    title: Annotated[str, Field(description="heading in the figure")],
    caption: Annotated[str, Field(description="sentence below the figure")],
) -> Figure:
    """A line for each class of members against their level: mean over those of one level, their range as a band."""
    found: dict[str, dict[float, list[float]]] = {}
    for level, (member, solution) in zip(levels_of(solvers), solvers.items(), strict=True):
        value = solution.metrics.get(metric, np.nan)
        found.setdefault(member.class_name, {}).setdefault(level, []).append(value)
    x = np.array(sorted({place for places in found.values() for place in places}))
    series = {
        line: np.array([(np.mean(v), np.min(v), np.max(v)) for v in (places.get(at, [np.nan]) for at in x)])
        for line, places in found.items()
    }
    y_label = y_label or metric.replace("_", " ")
    return sweep_plot(
        x,
        series,
        x_label=x_label,
        y_label=y_label,
        log=log,
        band="least to largest",
        title=title,
        caption=caption,
    )
