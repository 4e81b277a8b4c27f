"""Evaluations that a search over signs takes against the number of eigenfunctions."""

from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.member import Member
from surfexp.embedding.distance import Distance
from surfexp.figures.figure import Figure
from surfexp.figures.sweep_plot import sweep_plot
from surfexp.lab.registry.registry import register


@register("figure", "search_effort", defaults_of=sweep_plot)
def search_effort_figure(
    distances: dict[Member, Distance],
    *,
    title: Annotated[str, Field(description="heading in the figure")],
    caption: Annotated[str, Field(description="sentence below the figure")],
) -> Figure:
    """Evaluations against n, a line for each class of members, beside the 2^n of enumeration."""
    sizes = {member: found.source_points.shape[1] for member, found in distances.items()}
    x = np.array(sorted(set(sizes.values())), dtype=np.float64)
    lines = {"enumeration": 2.0**x}
    for member, found in distances.items():
        line = lines.setdefault(member.class_name, np.full(len(x), np.nan))
        line[np.searchsorted(x, sizes[member])] = found.evaluations
    return sweep_plot(
        x,
        lines,
        x_label="number of eigenfunctions n",
        y_label="evaluations of the distance",
        log="y",
        title=title,
        caption=caption,
    )
