"""Columns of a statistic, or signatures of a collection, as curves."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from surfexp.contract.member import Member
from surfexp.figures.figure import Figure
from surfexp.figures.order_plot import order_plot
from surfexp.figures.sweep_plot import sweep_plot
from surfexp.lab.registry.registry import register
from surfexp.spectrum.signature import Signature
from surfexp.statistics.statistic import Statistic

Title = Annotated[str, Field(description="heading in the figure")]
Caption = Annotated[str, Field(description="sentence below the figure")]


@register("figure", "curves", defaults_of=(order_plot, sweep_plot))
def curves_figure(
    statistic: Statistic,
    *,
    x: Annotated[str, Field(description="column along the horizontal axis")],
    y: Annotated[list[str], Field(description="columns that are drawn")],
    x_label: Annotated[str, Field(description="default: the column")] = "",
    y_label: Annotated[str, Field(description="what the curves are")] = "",
    log: Annotated[Literal["", "x", "y", "xy"], Field(description="logarithmic axes")],
    orders: Annotated[
        bool, Field(description="doubly logarithmic with the measured orders, finer to the right")
    ] = False,
    band: Annotated[str, Field(description="what bands are, where columns have intervals")],
    title: Title,
    caption: Caption,
) -> Figure:
    """Columns of a statistic against another one."""
    for name in (x, *y):
        if name not in statistic.columns:
            known = ", ".join(statistic.columns)
            raise ValueError(f"statistic {statistic.name!r} has no column {name!r}, choose one of {known}")
    abscissae = statistic.columns[x]
    lines = {name.replace("_", " "): statistic.columns[name] for name in y}
    x_label, title = x_label or x.replace("_", " "), title or statistic.name
    words = {"x_label": x_label, "y_label": y_label, "title": title, "caption": caption}
    if orders:
        return order_plot(abscissae, lines, **words)
    return sweep_plot(abscissae, lines, log=log, band=band, **words)


@register("figure", "signatures", defaults_of=sweep_plot)
def signatures_figure(
    signatures: dict[Member, Signature],
    *,
    part: Annotated[str, Field(description="part of the signatures; empty: the signature itself")] = "",
    by_class: Annotated[
        bool, Field(description="mean and range of each class instead of a curve for each shape")
    ] = True,
    ratio: Annotated[bool, Field(description="divide entry n by n")] = False,
    y_label: Annotated[str, Field(description="what the curves are; default: the signature")] = "",
    title: Title,
    caption: Caption,
) -> Figure:
    """Signatures against the number of the mode, by shape or by class (figures 4.2 and 4.6, top)."""
    rows = {member: signature.part(part) for member, signature in signatures.items()}
    length = min(len(row) for row in rows.values())
    numbers = np.arange(1.0, length + 1.0)
    rows = {member: row[:length] / (numbers if ratio else 1.0) for member, row in rows.items()}
    if by_class:
        lines = {}
        for name in dict.fromkeys(member.class_name for member in rows):
            members = np.stack([row for member, row in rows.items() if member.class_name == name])
            lines[name] = np.stack([members.mean(axis=0), members.min(axis=0), members.max(axis=0)], axis=1)
    else:
        lines = {member.label: row for member, row in rows.items()}
    name = part or next(iter(signatures.values())).name
    y_label = y_label or name.replace("_", " ") + (" / n" if ratio else "")
    return sweep_plot(
        numbers,
        lines,
        x_label="number of the mode",
        y_label=y_label,
        band="least to largest of a class",
        title=title,
        caption=caption,
    )
