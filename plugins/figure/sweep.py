"""A metric against an option, a line for each method."""

import re
from typing import Literal

import numpy as np
from pydantic import Field

from surfexp.figures.figure import Figure
from surfexp.figures.sweep_plot import sweep_plot
from surfexp.metric import MetricName
from surfexp.variational.solution import Solution
from surfexp.workflow.registry import Options, register

LABEL = re.compile(r"(?P<line>.+) @ (?P<x>[-+.\deE]+)(?: #\w+)?")


class Sweep(Options):
    """What is drawn against the numbers of an axis, and how it looks."""

    metric: MetricName = Field(description="metric of the solutions that is drawn")
    x_label: str = Field(description="what the numbers after @ are")
    y_label: str = Field("", description="default: the metric")
    log: Literal["", "x", "y", "xy"] = Field("", description="logarithmic axes")
    title: str = Field("", description="heading in the figure")
    caption: str = Field("", description="sentence below the figure")


@register("figure", "sweep")
def sweep_figure(options: Sweep, *, solvers: dict[str, Solution]) -> Figure:
    """Members of an axis labelled "line @ x" or "line @ x #seed": mean over the seeds, their range as a band."""
    found: dict[str, dict[float, list[float]]] = {}
    for label, solution in solvers.items():
        match = LABEL.fullmatch(label)
        if match is None:
            raise ValueError(f"axis label {label!r}: a sweep needs labels such as 'fem @ 20' or 'fem @ 20 #1'")
        value = solution.metrics.get(options.metric, np.nan)
        found.setdefault(match["line"], {}).setdefault(float(match["x"]), []).append(value)
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
