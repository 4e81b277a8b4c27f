"""Who is recognised, by descriptor and change."""

from typing import Annotated

from pydantic import Field

from surfexp.figures.figure import Figure
from surfexp.figures.grouped_intervals import grouped_intervals
from surfexp.lab.registry.registry import register
from surfexp.statistics.statistic import Statistic


@register("figure", "identification", defaults_of=grouped_intervals)
def identification_figure(
    statistics: dict[str, Statistic],
    *,
    column: Annotated[
        str, Field(description="column of the statistics, a value with its interval in each row")
    ] = "rank_one",
    x_label: Annotated[str, Field(description="what the values are")] = "share recognised",
    chance: Annotated[float | None, Field(ge=0, le=1, description="where a dashed line stands")] = None,
    title: Annotated[str, Field(description="heading in the figure")],
    caption: Annotated[str, Field(description="sentence below the figure")],
) -> Figure:
    """A value with its interval for each row of each member of an axis, a colour a row."""
    groups = {}
    for label, found in statistics.items():
        values = found.columns.get(column)
        if values is None or values.ndim != 2:
            known = ", ".join(name for name, values in found.columns.items() if values.ndim == 2)
            raise ValueError(f"statistic {label!r} has no column {column!r} with intervals, choose one of {known}")
        groups[label] = {row: values for row, values in zip(found.rows, values, strict=True) if row != "all"}
    return grouped_intervals(
        groups,
        x_label=x_label,
        reference=chance,
        reference_name="chance",
        title=title,
        caption=caption,
    )
