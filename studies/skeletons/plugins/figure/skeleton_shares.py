"""Figure 5.10: principal components of several groups of skeletons against each other."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from surfexp.figures.figure import Figure
from surfexp.figures.sweep_plot import sweep_plot
from surfexp.lab.registry.registry import register
from surfexp.statistics.statistic import Statistic


@register("figure", "skeleton_shares", defaults_of=sweep_plot)
def skeleton_shares_figure(
    statistics: dict[str, Statistic],
    *,
    quantity: Annotated[
        Literal["share", "variance"],
        Field(description="shares of the total with their intervals, or the variances that the text shows"),
    ] = "share",
    components: Annotated[int, Field(ge=2, le=100, description="number of components")] = 6,
    title: Annotated[str, Field(description="heading in the figure")],
    caption: Annotated[str, Field(description="sentence below the figure")],
) -> Figure:
    """Shares or variances of the principal components of skeletons, a line for each study, with bootstrap intervals."""
    series, count = {}, components
    for name, statistic in statistics.items():
        columns = statistic.columns
        if not {"component", "share", "low", "high", "variance"} <= set(columns):
            raise ValueError(f"statistic {name!r} has no components, take statistic skeleton_study")
        count = min(count, len(columns["component"]))
        bounded = np.stack([columns["share"], columns["low"], columns["high"]], axis=1)
        series[name] = bounded if quantity == "share" else columns["variance"]
    label = "share of the total variance" if quantity == "share" else "variance, mm²"
    return sweep_plot(
        np.arange(1.0, count + 1.0),
        {name: values[:count] for name, values in series.items()},
        x_label="component",
        y_label=label,
        band="bootstrap intervals",
        title=title,
        caption=caption,
    )
