"""Convergence of an iteration: gap, energy or error against iterations, on doubly logarithmic axes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.figures.axes import Label, add_axes, label_lines, logarithmic, style
from surfexp.figures.figure import Figure
from surfexp.figures.typography import QUIET, canvas, drawn, vector


def convergence_plot(
    histories: Mapping[str, tuple[Floats, Floats]],
    *,
    x_label: str = "iteration",
    y_label: str = "relative gap",
    rates: Sequence[float] = (),
    title: str = "",
    caption: str = "",
    size: tuple[int, int] = (1000, 620),
) -> Figure:
    """Histories, with dashed lines that fall like k^-rate for comparison.

    Parameters
    ----------
    histories : mapping of label to ((k,), (k,)) float64
        Iterations and values. Points that are not positive have no place on the axes; a note counts them.
    rates : sequence of float
        Orders of the lines for comparison, which start where the highest history starts.

    Raises
    ------
    ValueError
        If no history has a positive point.
    """
    kept = {name: _positive(*history) for name, history in histories.items()}
    lost = sum(len(histories[name][0]) - len(x) for name, (x, _) in kept.items())
    kept = {name: history for name, history in kept.items() if len(history[0])}
    if not kept:
        raise ValueError(f"convergence plot has {len(histories)} histories and no positive point, at least 1 is needed")
    with canvas(*size) as figure:
        axes = add_axes(figure, title, x_label, y_label)
        labels: list[Label] = []
        for k, (name, (x, y)) in enumerate(kept.items()):
            line = style(k) | {"marker": "o" if len(x) == 1 else ""}
            axes.plot(x, y, **line)
            labels.append((name, float(x[-1]), float(y[-1]), line["color"]))
        logarithmic(axes)
        _draw_rates(axes, kept, rates)
        label_lines(axes, labels)
        pixels, svg = drawn(figure), vector(figure)
    return Figure(
        pixels, caption, title, notes=(f"{lost} points that are not positive are left out.",) if lost else (), svg=svg
    )


def _positive(x: Floats, y: Floats) -> tuple[Floats, Floats]:
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    keep = (x > 0.0) & (y > 0.0) & np.isfinite(y)
    return x[keep], y[keep]


def _draw_rates(axes: Any, histories: Mapping[str, tuple[Floats, Floats]], rates: Sequence[float]) -> None:
    """Lines of slope -rate from the highest first point, within the axes."""
    x0, y0 = max(((x[0], y[0]) for x, y in histories.values()), key=lambda point: point[1])
    lowest = min(y.min() for _, y in histories.values())
    last = max(x.max() for x, _ in histories.values())
    for rate in rates:
        x = np.array([x0, min(last, x0 * (y0 / lowest) ** (1.0 / rate))])
        y = y0 * (x / x0) ** -rate
        axes.plot(x, y, color=QUIET, linewidth=1.0, linestyle=(0, (4, 3)), zorder=1.5)
        middle = np.sqrt(x[0] * x[1]), np.sqrt(y[0] * y[1])
        text = axes.text(*middle, f"$k^{{-{rate:g}}}$", ha="right", va="top", color=QUIET)
        text.set(
            fontsize=axes.xaxis.label.get_size(),
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0, "alpha": 0.85},
        )
