"""Points with intervals in groups: a group of rows for each method, a colour for each condition."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.figures.axes import FONT, add_axes, class_style
from surfexp.figures.figure import Figure
from surfexp.figures.typography import INK, QUIET, canvas, drawn, points, vector

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

ROW, BETWEEN = 0.95, 0.9
LEGEND = 2.2


def grouped_intervals(
    groups: Mapping[str, Mapping[str, Floats]],
    *,
    x_label: str,
    reference: float | None = None,
    reference_name: str = "",
    title: str = "",
    caption: str = "",
    width: int = 1000,
) -> Figure:
    """A row for each condition of each group, groups one below the other; the height follows from their number.

    Parameters
    ----------
    groups : mapping of group to mapping of condition to (3,) float64
        Value, lower and upper end.
    x_label : str
    reference : float, optional
        Where a dashed line stands, chance for instance.
    reference_name, title, caption : str
    width : int
        Pixels.

    Raises
    ------
    ValueError
        If there is no interval.
    """
    conditions = list(dict.fromkeys(name for rows in groups.values() for name in rows))
    if not conditions:
        raise ValueError(f"{len(groups)} groups have no interval, at least 1 is needed")
    em = FONT * width
    lengths = [len(rows) * ROW + BETWEEN for rows in groups.values()]
    height = round(em * (sum(lengths) + LEGEND + (6.4 if title else 4.8)))
    with canvas(width, height) as figure:
        axes = add_axes(figure, title, x_label, "")
        starts = np.concatenate([[0.0], np.cumsum(lengths)])
        handles = _rows(axes, groups, starts, conditions, em)
        if reference is not None:
            axes.axvline(reference, color=QUIET, linewidth=1.0, linestyle=(0, (4, 3)), zorder=1.5)
            beside = axes.get_xaxis_transform()
            axes.text(reference, 0.0, f" {reference_name}", transform=beside, color=QUIET, ha="left", va="bottom")
        axes.set_yticks(starts[:-1] + 0.5 * (np.array(lengths) - BETWEEN), list(groups))
        axes.set_ylim(starts[-1], -0.3)
        _make_room(axes, width, LEGEND * em / height)
        axes.legend(
            [handles[name] for name in conditions], conditions, loc="lower left", bbox_to_anchor=(0.0, 1.0),
            ncols=len(conditions), frameon=False, labelcolor=INK, fontsize=points(0.9 * em), borderaxespad=0.2,
            handletextpad=0.2, columnspacing=1.2,
        )  # fmt: skip
        axes.set_title(title, x=0.0, fontsize=points(1.1 * em), fontweight="bold", pad=points(2.2 * em))
        pixels, svg = drawn(figure), vector(figure)
    return Figure(pixels, caption, title, svg=svg)


def _rows(
    axes: Axes, groups: Mapping[str, Mapping[str, Floats]], starts: Floats, conditions: list[str], em: float
) -> dict[str, Line2D]:
    """Draw the intervals and what divides the groups; return a point of each condition."""
    handles: dict[str, Line2D] = {}
    for start, rows in zip(starts, groups.values(), strict=False):
        for k, (name, interval) in enumerate(rows.items()):
            value, lower, upper = (float(part) for part in interval)
            color, marker = class_style(conditions.index(name))
            place = start + ROW * (k + 0.5)
            axes.plot([lower, upper], [place, place], color=color, linewidth=points(0.12 * em))
            handles[name] = axes.plot(
                [value], [place], color=color, marker=marker, markersize=points(0.5 * em), linestyle="none"
            )[0]
    for edge in starts[1:-1]:
        axes.axhline(edge - 0.5 * BETWEEN, color="#e6e6e6", linewidth=0.8)
    axes.grid(visible=False, axis="y")
    axes.spines["left"].set_visible(False)
    return handles


def _make_room(axes: Axes, width: int, above: float) -> None:
    """Leave room for the names of the groups at the left and for the legend above."""
    axes.tick_params(axis="y", length=0.0)
    box = axes.get_position()
    left = max(label.get_window_extent().width for label in axes.get_yticklabels()) / width + box.x0
    axes.set_position((left, box.y0, box.x1 - left, box.height - above))
