"""Columns of a statistic less others, as curves."""

from typing import Literal

from pydantic import Field

from surfexp.contract.arrays import Floats
from surfexp.figures.figure import Figure
from surfexp.figures.sweep_plot import sweep_plot
from surfexp.lab.registry.registry import Options, register
from surfexp.statistics.statistic import Statistic


class DifferenceCurves(Options):
    """Which columns are subtracted, against which they are drawn."""

    x: str = Field(description="column along the horizontal axis")
    differences: dict[str, tuple[str, str]] = Field(description="by label: a column, and the one that is subtracted")
    x_label: str = Field("", description="default: the column")
    y_label: str = Field("difference", description="what the curves are")
    log: Literal["", "x"] = Field("", description="logarithmic axis")
    title: str = Field("", description="heading in the figure")
    caption: str = Field("", description="sentence below the figure")


@register("figure", "difference_curves")
def difference_curves_figure(options: DifferenceCurves, *, statistic: Statistic) -> Figure:
    """Columns of a statistic less others against a third one; of columns with intervals the values alone."""
    for name in (options.x, *(name for pair in options.differences.values() for name in pair)):
        if name not in statistic.columns:
            known = ", ".join(statistic.columns)
            raise ValueError(f"statistic {statistic.name!r} has no column {name!r}, choose of {known}")

    def values(name: str) -> Floats:
        column = statistic.columns[name]
        return column[:, 0] if column.ndim == 2 else column

    return sweep_plot(
        values(options.x),
        {label: values(one) - values(other) for label, (one, other) in options.differences.items()},
        x_label=options.x_label or options.x,
        y_label=options.y_label,
        log=options.log,
        title=options.title or statistic.name,
        caption=options.caption,
    )
