"""Columns of a statistic, or signatures of a collection, as curves."""

from typing import Literal

import numpy as np
from pydantic import Field

from surfexp.contract.member import Member
from surfexp.figures.figure import Figure
from surfexp.figures.order_plot import order_plot
from surfexp.figures.sweep_plot import sweep_plot
from surfexp.lab.registry.registry import Options, register
from surfexp.spectrum.signature import Signature
from surfexp.statistics.statistic import Statistic


class Curves(Options):
    """Which columns are drawn, against which."""

    x: str = Field(description="column along the horizontal axis")
    y: list[str] = Field(description="columns that are drawn")
    x_label: str = Field("", description="default: the column")
    y_label: str = Field("", description="what the curves are")
    log: Literal["", "x", "y", "xy"] = Field("", description="logarithmic axes")
    orders: bool = Field(False, description="doubly logarithmic with the measured orders, finer to the right")
    title: str = Field("", description="heading in the figure")
    caption: str = Field("", description="sentence below the figure")


@register("figure", "curves")
def curves_figure(options: Curves, *, statistic: Statistic) -> Figure:
    """Columns of a statistic against another one."""
    for name in (options.x, *options.y):
        if name not in statistic.columns:
            known = ", ".join(statistic.columns)
            raise ValueError(f"statistic {statistic.name!r} has no column {name!r}, choose one of {known}")
    x = statistic.columns[options.x]
    lines = {name.replace("_", " "): statistic.columns[name] for name in options.y}
    x_label, title = options.x_label or options.x.replace("_", " "), options.title or statistic.name
    words = {"x_label": x_label, "y_label": options.y_label, "title": title, "caption": options.caption}
    return order_plot(x, lines, **words) if options.orders else sweep_plot(x, lines, log=options.log, **words)


class SignatureCurves(Options):
    """Which part of the signatures is drawn."""

    part: str = Field("", description="part of the signatures; empty: the signature itself")
    by_class: bool = Field(True, description="mean and range of each class instead of a curve for each shape")
    ratio: bool = Field(False, description="divide entry n by n")
    y_label: str = Field("", description="what the curves are; default: the signature")
    title: str = Field("", description="heading in the figure")
    caption: str = Field("", description="sentence below the figure")


@register("figure", "signatures")
def signatures_figure(options: SignatureCurves, *, signatures: dict[Member, Signature]) -> Figure:
    """Signatures against the number of the mode, by shape or by class (figures 4.2 and 4.6, top)."""
    rows = {member: signature.part(options.part) for member, signature in signatures.items()}
    length = min(len(row) for row in rows.values())
    numbers = np.arange(1.0, length + 1.0)
    rows = {member: row[:length] / (numbers if options.ratio else 1.0) for member, row in rows.items()}
    if options.by_class:
        lines = {}
        for name in dict.fromkeys(member.class_name for member in rows):
            members = np.stack([row for member, row in rows.items() if member.class_name == name])
            lines[name] = np.stack([members.mean(axis=0), members.min(axis=0), members.max(axis=0)], axis=1)
    else:
        lines = {member.label: row for member, row in rows.items()}
    name = options.part or next(iter(signatures.values())).name
    y_label = options.y_label or name.replace("_", " ") + (" / n" if options.ratio else "")
    return sweep_plot(
        numbers, lines, x_label="number of the mode", y_label=y_label, title=options.title, caption=options.caption
    )
