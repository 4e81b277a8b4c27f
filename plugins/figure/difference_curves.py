"""Columns of a statistic less others, as curves."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.contract.arrays import Floats
from surfexp.figures.figure import Figure
from surfexp.figures.sweep_plot import sweep_plot
from surfexp.lab.registry.registry import register
from surfexp.statistics.statistic import Statistic


@register("figure", "difference_curves", defaults_of=sweep_plot)
def difference_curves_figure(
    statistic: Statistic,
    *,
    x: Annotated[str, Field(description="column along the horizontal axis")],
    differences: Annotated[
        dict[str, tuple[str, str]], Field(description="by label: a column, and the one that is subtracted")
    ],
    x_label: Annotated[str, Field(description="default: the column")] = "",
    y_label: Annotated[str, Field(description="what the curves are")] = "difference",
    log: Annotated[Literal["", "x"], Field(description="logarithmic axis")],
    title: Annotated[str, Field(description="heading in the figure")],
    caption: Annotated[str, Field(description="sentence below the figure")],
) -> Figure:
    """Columns of a statistic less others against a third one; of columns with intervals the values alone."""
    for name in (x, *(name for pair in differences.values() for name in pair)):
        if name not in statistic.columns:
            known = ", ".join(statistic.columns)
            raise ValueError(f"statistic {statistic.name!r} has no column {name!r}, choose of {known}")

    def values(name: str) -> Floats:
        column = statistic.columns[name]
        return column[:, 0] if column.ndim == 2 else column

    return sweep_plot(
        values(x),
        {label: values(one) - values(other) for label, (one, other) in differences.items()},
        x_label=x_label or x,
        y_label=y_label,
        log=log,
        title=title or statistic.name,
        caption=caption,
    )
