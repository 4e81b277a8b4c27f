"""Sweeps: a metric against an option, a line for each method."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.figures.axes import Label, add_axes, label_lines, logarithmic, style
from surfexp.figures.figure import Figure
from surfexp.figures.typography import canvas, drawn, vector

# up to so many values of the option are written under the axis, and each marked on the lines
MOST_TICKS, MOST_MARKERS = 9, 60
# length of the dashes in which lines that lie on one another take turns, in widths of a line
DASH = 4.0


def sweep_plot(
    x: Floats,
    series: Mapping[str, Floats],
    *,
    x_label: str,
    y_label: str,
    log: str = "",
    band: str = "",
    title: str = "",
    caption: str = "",
    size: tuple[int, int] = (1000, 620),
) -> Figure:
    """A line for each method, with markers up to 60 values, and a band where an interval is known.

    Lines that lie on one another take turns, in dashes and in markers.

    Parameters
    ----------
    x : (k,) float64
        The option's values, increasing.
    series : mapping of label to (k,) or (k, 3) float64
        Values, or value, lower and upper end. NaN leaves a gap.
    log : "", "x", "y" or "xy"
        Which axes are logarithmic.
    band : str
        What bands are, written below the axes where there is one.

    Raises
    ------
    ValueError
        If there is nothing to draw, or lengths differ.
    """
    for name, values in series.items():
        if np.shape(values) not in ((len(x),), (len(x), 3)):
            raise ValueError(f"{name!r} has shape {np.shape(values)}, expected ({len(x)},) or ({len(x)}, 3)")
    if not any(np.isfinite(values).any() for values in series.values()):
        raise ValueError(f"sweep plot has {len(series)} lines and no finite value, at least 1 is needed")
    with canvas(*size) as figure:
        bounded_ones = band and any(np.ndim(values) == 2 for values in series.values())
        axes = add_axes(figure, title, f"{x_label}\nbands: {band}" if bounded_ones else x_label, y_label)
        labels: list[Label] = []
        for k, (name, values) in enumerate(series.items()):
            bounded = np.asarray(values, dtype=float).reshape(len(x), -1)
            look = style(k) | _turns(series, k) | ({} if len(x) <= MOST_MARKERS else {"marker": ""})
            axes.plot(x, bounded[:, 0], **look)
            if bounded.shape[1] == 3:
                axes.fill_between(x, bounded[:, 1], bounded[:, 2], color=style(k)["color"], alpha=0.15, linewidth=0.0)
            for last in np.flatnonzero(np.isfinite(bounded[:, 0]))[-1:]:
                labels.append((name, float(x[last]), float(bounded[last, 0]), style(k)["color"]))
        logarithmic(axes, log)
        if len(x) <= MOST_TICKS:
            axes.set_xticks(x, [f"{value:g}" for value in x])
        label_lines(axes, labels)
        pixels, svg = drawn(figure), vector(figure)
    return Figure(pixels, caption, title, svg=svg)


def _turns(series: Mapping[str, Floats], k: int) -> dict[str, Any]:
    """Dashes and markers of the k-th line that leave room for those of the others with its values."""
    lines = [np.asarray(values, dtype=float).reshape(len(values), -1)[:, 0] for values in series.values()]
    twins = [i for i, line in enumerate(lines) if np.allclose(lines[k], line, rtol=1e-3, equal_nan=True)]
    turn, count = twins.index(k), len(twins)
    if count == 1:
        return {}
    return {"linestyle": ((count - turn) * DASH, (DASH, (count - 1) * DASH)), "markevery": (turn, count)}
