"""Points with intervals, one method below the other."""

from __future__ import annotations

from collections.abc import Mapping

from surfexp.contract.arrays import Floats
from surfexp.figures.axes import COLORS, FONT, add_axes
from surfexp.figures.figure import Figure
from surfexp.figures.typography import QUIET, canvas, drawn, points, vector

ROW = 2.2


def interval_plot(
    intervals: Mapping[str, tuple[float, float, float] | Floats],
    *,
    x_label: str,
    reference: float | None = None,
    reference_name: str = "",
    title: str = "",
    caption: str = "",
    width: int = 1000,
) -> Figure:
    """A point with its interval for each name; the height follows from their number.

    Parameters
    ----------
    intervals : mapping of label to (value, lower, upper)
    reference : float, optional
        Where a dashed line stands: no effect, chance, the exact value.
    reference_name : str
        What is written at its lower end.

    Raises
    ------
    ValueError
        If there is no interval.
    """
    if not intervals:
        raise ValueError("interval plot has 0 intervals, at least 1 is needed")
    em = FONT * width
    height = round(em * (ROW * len(intervals) + (6.4 if title else 4.8)))
    with canvas(width, height) as figure:
        axes = add_axes(figure, title, x_label, "")
        axes.grid(visible=False, axis="y")
        axes.spines["left"].set_visible(False)
        for k, (value, lower, upper) in enumerate(intervals.values()):
            axes.plot([lower, upper], [k, k], color=COLORS[0], linewidth=points(0.15 * em), solid_capstyle="round")
            axes.plot([value], [k], color=COLORS[0], marker="o", markersize=points(0.6 * em))
        if reference is not None:
            axes.axvline(reference, color=QUIET, linewidth=1.0, linestyle=(0, (4, 3)), zorder=1.5)
            beside = axes.get_xaxis_transform()
            axes.text(reference, 0.0, f" {reference_name}", transform=beside, color=QUIET, ha="left", va="bottom")
        axes.set_yticks(range(len(intervals)), list(intervals))
        axes.tick_params(axis="y", length=0.0)
        axes.set_ylim(len(intervals) - 0.5, -0.5)
        box = axes.get_position()
        left = max(label.get_window_extent().width for label in axes.get_yticklabels()) / width + box.x0
        axes.set_position([left, box.y0, box.x1 - left, box.height])
        pixels, svg = drawn(figure), vector(figure)
    return Figure(pixels, caption, title, svg=svg)
