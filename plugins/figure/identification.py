"""Who is recognised, by descriptor and change."""

from pydantic import Field

from surfexp.figures.figure import Figure
from surfexp.figures.grouped_intervals import grouped_intervals
from surfexp.lab.registry.registry import Options, register
from surfexp.statistics.statistic import Statistic


class IdentificationFigure(Options):
    """What is drawn, and what is written above and below."""

    column: str = Field("rank_one", description="column of the statistics, a value with its interval in each row")
    x_label: str = Field("share recognised", description="what the values are")
    chance: float | None = Field(None, ge=0, le=1, description="where a dashed line stands")
    title: str = Field("", description="heading in the figure")
    caption: str = Field("", description="sentence below the figure")


@register("figure", "identification")
def identification_figure(options: IdentificationFigure, *, statistics: dict[str, Statistic]) -> Figure:
    """A value with its interval for each row of each member of an axis, a colour a row."""
    groups = {}
    for label, found in statistics.items():
        column = found.columns.get(options.column)
        if column is None or column.ndim != 2:
            known = ", ".join(name for name, values in found.columns.items() if values.ndim == 2)
            raise ValueError(
                f"statistic {label!r} has no column {options.column!r} with intervals, choose one of {known}"
            )
        groups[label] = {row: values for row, values in zip(found.rows, column, strict=True) if row != "all"}
    return grouped_intervals(
        groups,
        x_label=options.x_label,
        reference=options.chance,
        reference_name="chance",
        title=options.title,
        caption=options.caption,
    )
