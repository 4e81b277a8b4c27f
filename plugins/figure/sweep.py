"""A metric against an option, a line for each method."""

from typing import Literal

import numpy as np
from pydantic import Field

from surfexp.contract.member import Member, levels_of
from surfexp.contract.metric import MetricName
from surfexp.figures.figure import Figure
from surfexp.figures.sweep_plot import sweep_plot
from surfexp.lab.registry.registry import Options, register
from surfexp.variational.solution import Solution


class Sweep(Options):
    """What is drawn against the numbers of an axis, and how it looks."""

    metric: MetricName = Field(description="metric of the solutions that is drawn")
    x_label: str = Field(description="what the levels of the members are")
    y_label: str = Field("", description="default: the metric")
    log: Literal["", "x", "y", "xy"] = Field("", description="logarithmic axes")
    title: str = Field("", description="heading in the figure")
    caption: str = Field("", description="sentence below the figure")


@register("figure", "sweep")
def sweep_figure(options: Sweep, *, solvers: dict[Member, Solution]) -> Figure:
    """A line for each class of members against their level: mean over those of one level, their range as a band."""
    found: dict[str, dict[float, list[float]]] = {}
    for level, (member, solution) in zip(levels_of(solvers), solvers.items(), strict=True):
        value = solution.metrics.get(options.metric, np.nan)
        found.setdefault(member.class_name, {}).setdefault(level, []).append(value)
    x = np.array(sorted({place for places in found.values() for place in places}))
    series = {
        line: np.array([(np.mean(v), np.min(v), np.max(v)) for v in (places.get(at, [np.nan]) for at in x)])
        for line, places in found.items()
    }
    y_label = options.y_label or options.metric.replace("_", " ")
    return sweep_plot(
        x,
        series,
        x_label=options.x_label,
        y_label=y_label,
        log=options.log,
        title=options.title,
        caption=options.caption,
    )
