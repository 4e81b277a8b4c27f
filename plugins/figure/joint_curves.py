"""Columns of several statistics as curves in one figure."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from surfexp.contract.arrays import Floats
from surfexp.figures.figure import Figure
from surfexp.figures.sweep_plot import sweep_plot
from surfexp.lab.registry.registry import register
from surfexp.statistics.statistic import Statistic


@register("figure", "joint_curves", defaults_of=sweep_plot)
def joint_curves_figure(
    statistics: dict[str, Statistic],
    *,
    x: Annotated[str, Field(description="column along the horizontal axis")],
    y: Annotated[list[str], Field(description="columns that are drawn, of each statistic")],
    x_label: Annotated[str, Field(description="default: the column")] = "",
    y_label: Annotated[str, Field(description="what the curves are; default: the columns")] = "",
    log: Annotated[Literal["", "x", "y", "xy"], Field(description="logarithmic axes")],
    title: Annotated[str, Field(description="heading in the figure")],
    caption: Annotated[str, Field(description="sentence below the figure")],
) -> Figure:
    """Columns of each statistic of an axis against another one, a curve for each member and column."""
    for label, statistic in statistics.items():
        for name in (x, *y):
            if name not in statistic.columns:
                known = ", ".join(statistic.columns)
                raise ValueError(f"statistic {label!r} has no column {name!r}, choose one of {known}")
    abscissae = np.unique(np.concatenate([statistic.columns[x] for statistic in statistics.values()]))
    lines = {
        f"{label}, {name}" if len(y) > 1 else label: _on(abscissae, statistic, x, name)
        for label, statistic in statistics.items()
        for name in y
    }
    return sweep_plot(
        abscissae,
        lines,
        x_label=x_label or x,
        y_label=y_label or ", ".join(y),
        log=log,
        title=title,
        caption=caption,
    )


def _on(x: Floats, statistic: Statistic, along: str, name: str) -> Floats:
    """A column on all values of x, NaN where the statistic has none."""
    values = statistic.columns[name]
    result = np.full((len(x), *values.shape[1:]), np.nan)
    result[np.searchsorted(x, statistic.columns[along])] = values
    return result
