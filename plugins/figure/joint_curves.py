"""Columns of several statistics as curves in one figure."""

from typing import Literal

import numpy as np
from pydantic import Field

from surfexp.contract.arrays import Floats
from surfexp.figures.figure import Figure
from surfexp.figures.sweep_plot import sweep_plot
from surfexp.lab.registry.registry import Options, register
from surfexp.statistics.statistic import Statistic


class JointCurves(Options):
    """Which columns are drawn, against which."""

    x: str = Field(description="column along the horizontal axis")
    y: list[str] = Field(description="columns that are drawn, of each statistic")
    x_label: str = Field("", description="default: the column")
    y_label: str = Field("", description="what the curves are; default: the columns")
    log: Literal["", "x", "y", "xy"] = Field("", description="logarithmic axes")
    title: str = Field("", description="heading in the figure")
    caption: str = Field("", description="sentence below the figure")


@register("figure", "joint_curves")
def joint_curves_figure(options: JointCurves, *, statistics: dict[str, Statistic]) -> Figure:
    """Columns of each statistic of an axis against another one, a curve for each member and column."""
    for label, statistic in statistics.items():
        for name in (options.x, *options.y):
            if name not in statistic.columns:
                known = ", ".join(statistic.columns)
                raise ValueError(f"statistic {label!r} has no column {name!r}, choose one of {known}")
    x = np.unique(np.concatenate([statistic.columns[options.x] for statistic in statistics.values()]))
    lines = {
        f"{label}, {name}" if len(options.y) > 1 else label: _on(x, statistic, options.x, name)
        for label, statistic in statistics.items()
        for name in options.y
    }
    return sweep_plot(
        x,
        lines,
        x_label=options.x_label or options.x,
        y_label=options.y_label or ", ".join(options.y),
        log=options.log,
        title=options.title,
        caption=options.caption,
    )


def _on(x: Floats, statistic: Statistic, along: str, name: str) -> Floats:
    """A column on all values of x, NaN where the statistic has none."""
    values = statistic.columns[name]
    result = np.full((len(x), *values.shape[1:]), np.nan)
    result[np.searchsorted(x, statistic.columns[along])] = values
    return result
