"""Ratios of errors by data set and method."""

from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.member import Member
from surfexp.figures.figure import Figure
from surfexp.figures.ratio_table import ratio_table
from surfexp.lab.registry.registry import register
from surfexp.statistics.statistic import Statistic


@register("figure", "ratio_table", defaults_of=ratio_table)
def ratio_table_figure(
    statistics: dict[Member, Statistic],
    *,
    title: Annotated[str, Field(description="heading in the figure; default: what was compared")],
    caption: Annotated[str, Field(description="sentence below the figure")],
    width: Annotated[int, Field(ge=300, le=4000, description="pixels across")],
) -> Figure:
    """Median ratios of errors in colours, a row a data set; bold where the interval lies beyond 2 in a hundred."""
    first = next(iter(statistics.values()))
    for member, found in statistics.items():
        if found.rows != first.rows:
            raise ValueError(f"{member.label!r} compares {', '.join(found.rows)}, the first {', '.join(first.rows)}")
    ratios = np.array([found.columns["to_reference"][:, 0] for found in statistics.values()])
    verdicts = np.array([found.columns["verdict"] for found in statistics.values()])
    names = [name.replace("_", " ") for name in first.rows]
    return ratio_table(
        ratios,
        verdicts,
        [member.label for member in statistics],
        names,
        title=title or first.name,
        caption=caption,
        width=width,
    )
