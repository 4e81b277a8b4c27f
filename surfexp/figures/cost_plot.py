"""Accuracy against cost: the seconds that each method takes to each accuracy, on doubly logarithmic axes."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.figures.axes import Label, add_axes, label_lines, logarithmic, style
from surfexp.figures.figure import Figure
from surfexp.figures.typography import canvas, drawn, vector


def cost_plot(
    methods: Mapping[str, tuple[Floats, Floats]],
    *,
    y_label: str = "relative gap",
    title: str = "",
    caption: str = "",
    size: tuple[int, int] = (1000, 620),
) -> Figure:
    """A line with markers for each method, and a band over repetitions.

    Parameters
    ----------
    methods : mapping of label to ((k,), (k, 3)) float64
        Accuracies that were reached, and the seconds to each: middle, least and greatest. All positive.

    Raises
    ------
    ValueError
        If there is no method, or a number is not positive.
    """
    if not methods:
        raise ValueError("cost plot has 0 methods, at least 1 is needed")
    for name, (reached, seconds) in methods.items():
        least = min(np.min(reached), np.min(seconds))
        if not least > 0.0:
            raise ValueError(f"{name!r} has the number {least:g}, logarithmic axes take positive ones")
    with canvas(*size) as figure:
        axes = add_axes(figure, title, "processor seconds", y_label)
        labels: list[Label] = []
        for k, (name, (reached, seconds)) in enumerate(methods.items()):
            order = np.argsort(-np.asarray(reached))
            y, (x, low, high) = np.asarray(reached)[order], np.asarray(seconds)[order].T
            axes.plot(x, y, **style(k))
            axes.fill_betweenx(y, low, high, color=style(k)["color"], alpha=0.15, linewidth=0.0)
            labels.append((name, float(x[-1]), float(y[-1]), style(k)["color"]))
        logarithmic(axes)
        label_lines(axes, labels)
        pixels, svg = drawn(figure), vector(figure)
    return Figure(pixels, caption, title, svg=svg)
