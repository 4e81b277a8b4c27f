"""Figure 5.10: principal components of several groups of skeletons against each other."""

from typing import Literal

import numpy as np
from pydantic import Field

from surfexp.figures.figure import Figure
from surfexp.figures.sweep_plot import sweep_plot
from surfexp.lab.registry.registry import Options, register
from surfexp.statistics.statistic import Statistic


class SkeletonShares(Options):
    """What is drawn of the components."""

    quantity: Literal["share", "variance"] = Field(
        "share", description="shares of the total with their intervals, or the variances that the text shows"
    )
    components: int = Field(6, ge=2, le=100, description="number of components")
    title: str = Field("", description="heading in the figure")
    caption: str = Field("", description="sentence below the figure")


@register("figure", "skeleton_shares")
def skeleton_shares_figure(options: SkeletonShares, *, statistics: dict[str, Statistic]) -> Figure:
    """Shares or variances of the principal components of skeletons, a line for each study, with bootstrap intervals."""
    series, count = {}, options.components
    for name, statistic in statistics.items():
        columns = statistic.columns
        if not {"component", "share", "low", "high", "variance"} <= set(columns):
            raise ValueError(f"statistic {name!r} has no components, take statistic skeleton_study")
        count = min(count, len(columns["component"]))
        bounded = np.stack([columns["share"], columns["low"], columns["high"]], axis=1)
        series[name] = bounded if options.quantity == "share" else columns["variance"]
    label = "share of the total variance" if options.quantity == "share" else "variance, mm²"
    return sweep_plot(
        np.arange(1.0, count + 1.0),
        {name: values[:count] for name, values in series.items()},
        x_label="component",
        y_label=label,
        title=options.title,
        caption=options.caption,
    )
