"""Axes of plots: quiet grid, colours for every eye, and labels at the ends of lines instead of a legend."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.figures.contrast import ink_like
from surfexp.figures.typography import points

# Okabe and Ito (2008) without the yellow, which is too light for lines; told apart in every common colour blindness
COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000")
DASHES = ("-", (0, (5, 1.5)), (0, (1.5, 1.2)), (0, (6, 1.5, 1.2, 1.5)))
MARKERS = ("o", "s", "^", "D", "v", "P", "X")
# font as a share of the figure's width; spacing of labels in lines of text
FONT, SPACING = 0.0175, 1.35
# numbers between these are written without a power of ten
PLAIN = (1e-3, 1e6)

Label = tuple[str, float, float, str]


def style(k: int) -> dict[str, Any]:
    """Colour, dash and marker of the k-th line; the first 28 differ."""
    return {
        "color": COLORS[k % len(COLORS)],
        "linestyle": DASHES[k // len(COLORS) % len(DASHES)],
        "marker": MARKERS[k % len(MARKERS)],
    }


def class_style(k: int) -> tuple[str, str]:
    """Colour and marker of the k-th class; where the colours begin anew the markers are shifted, so that 49 differ."""
    return COLORS[k % len(COLORS)], MARKERS[(k + k // len(COLORS)) % len(MARKERS)]


def add_axes(figure: Any, title: str, x_label: str, y_label: str) -> Any:
    """The axes of a plot, with its title above the left end and room for the labels of the axes."""
    width, height = figure.bbox.width, figure.bbox.height
    em = FONT * width
    left = (5.5 if y_label else 1.0) * em
    bottom = (3.8 + SPACING * x_label.count("\n")) * em
    top = (2.6 if title else 1.0) * em
    rectangle = (left / width, bottom / height, 1.0 - (left + em) / width, 1.0 - (bottom + top) / height)
    axes = figure.add_axes(rectangle)
    axes.set_xlabel(x_label, fontsize=points(em), labelpad=points(0.3 * em))
    axes.set_ylabel(y_label, fontsize=points(em), labelpad=points(0.3 * em))
    axes.set_title(title, fontsize=points(1.1 * em), fontweight="bold", pad=points(0.9 * em))
    axes.tick_params(labelsize=points(0.9 * em), length=points(0.3 * em), which="major")
    axes.tick_params(length=0.0, which="minor")
    return axes


def logarithmic(axes: Any, names: str = "xy") -> None:
    """Logarithmic axes with ticks at powers of ten, or at 1, 2, 5 where less than two decades are seen.

    Numbers from a thousandth to a million are written out.
    """
    from matplotlib.ticker import LogLocator, NullFormatter

    for name in names:
        axes.set(**{f"{name}scale": "log"})
        axis = getattr(axes, f"{name}axis")
        low, high = sorted(axis.get_view_interval())
        if high < 100.0 * low:
            axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        # margins reach a little beyond the outermost numbers
        if high < 100.0 * low or PLAIN[0] <= 2.0 * low < high <= 2.0 * PLAIN[1]:
            axis.set_major_formatter(lambda value, _: _plain(value))
        axis.set_minor_formatter(NullFormatter())


def _plain(value: float) -> str:
    """A number of an axis: written out where that is short, as in tables."""
    written_out = PLAIN[0] <= abs(value) <= PLAIN[1]
    return f"{value:,.10g}".replace(",", "\u202f") if written_out else f"{value:.3g}"


def label_lines(axes: Any, labels: Sequence[Label]) -> None:
    """Write each label (text, x, y, colour) right of the axes, level with the end (x, y) of its line.

    Labels are moved apart as little as possible (least squares) and joined to their lines by thin leaders. The axes
    become narrower by the width of the longest label.
    """
    from matplotlib.lines import Line2D

    if not labels:
        return
    axes.autoscale_view()
    figure = axes.figure
    width, em = figure.bbox.width, FONT * figure.bbox.width
    texts = [
        figure.text(0.0, 0.0, text, color=ink_like(color), fontsize=points(em), va="center")
        for text, *_, color in labels
    ]
    longest = max(text.get_window_extent().width for text in texts)
    box = axes.get_position()
    axes.set_position([box.x0, box.y0, 1.0 - box.x0 - (longest + 2.5 * em) / width, box.height])
    ends = axes.transData.transform([(x, y) for _, x, y, _ in labels])
    right = axes.bbox.x1
    lowest, highest = 0.7 * em, figure.bbox.height - 0.7 * em
    heights = spread(np.clip(ends[:, 1], axes.bbox.y0, axes.bbox.y1), SPACING * em, lowest, highest)
    to_figure = figure.transFigure.inverted()
    for text, (x, y), height, (*_, color) in zip(texts, ends, heights, labels, strict=True):
        text.set_position(to_figure.transform((right + 1.8 * em, height)))
        leader = to_figure.transform([(x, y), (right, y), (right + 1.5 * em, height)])
        # a line that ends early is continued to the margin
        figure.add_artist(Line2D(*leader.T, color=color, linewidth=0.8, alpha=0.6))


def spread(positions: Floats, spacing: float, lowest: float = -np.inf, highest: float = np.inf) -> Floats:
    """The nearest positions in the least-squares sense, in the same order, that are at least `spacing` apart.

    They are not below `lowest` nor above `highest`, unless there is no room between the two: then the spacing gives way.
    """
    from scipy.optimize import isotonic_regression

    if len(positions) > 1:
        spacing = min(spacing, (highest - lowest) / (len(positions) - 1))
    order = np.argsort(positions, kind="stable")
    steps = spacing * np.arange(len(positions))
    result = np.empty(len(positions))
    # the bounded isotonic regression is the free one, cut off
    free = isotonic_regression(positions[order] - steps).x
    result[order] = np.clip(free, lowest, highest - steps[-1]) + steps
    return result
