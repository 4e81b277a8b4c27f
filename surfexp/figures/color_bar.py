"""Colour bars below a grid of pictures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.figures.colormap import ColorScale
from surfexp.figures.panel_layout import BAR_BAND, LETTER, WORD_BAND, Grid, Layout
from surfexp.figures.render import SurfaceView
from surfexp.figures.typography import QUIET, points

# longest bar as a share of the panel's width; the rest in multiples of the text's size
LONGEST, THICKNESS, DISTANCE, OUTLINE, TICK_FONT = 0.26, 0.75, 0.22, 0.045, 0.92
# intervals of a bar, and the room of a digit in multiples of the text's size
MOST_TICKS, DIGIT = 5, 0.6
# least room between the words of two bars, in the same
GAP = 1.0
ENDS = {(False, False): "neither", (True, False): "min", (False, True): "max", (True, True): "both"}

Scales = Mapping[ColorScale, ColorScale]


def fitted_scales(views: Sequence[SurfaceView]) -> dict[ColorScale, ColorScale]:
    """Each distinct scale, and the same with the limits that all its views share, in order of appearance."""
    distinct = dict.fromkeys(view.scale for view in views if view.is_scalar)
    return {scale: scale.fitted(values_on(scale, views)) for scale in distinct}


def values_on(scale: ColorScale, views: Sequence[SurfaceView]) -> Floats:
    """All values that a bar stands for."""
    found = {id(v.values): v.values for v in views if v.values is not None and v.is_scalar and v.scale == scale}
    return np.concatenate([*found.values()])


def bars_height(scales: Scales, views: Sequence[SurfaceView], width: float, em: float) -> int:
    """Height of the foot that the bars need in pixels, 0 without bars."""
    words = [_words(scale, fitted, views) for scale, fitted in scales.items()]
    return len(_lines(words, width, em)) * _line_height(words, em)


def draw_bars(figure: Any, layout: Layout, grid: Grid, scales: Scales) -> None:
    """One bar for each scale, in the foot of a panel; an end is pointed where values lie beyond it."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    views = [view for row in grid for view in row]
    words = [_words(scale, fitted, views) for scale, fitted in scales.items()]
    lines = _lines(words, layout.width, layout.em)
    most = max((len(line) for line in lines), default=1)
    length = min(LONGEST, 0.8 / most, 0.85 * min(layout.columns) / layout.width if most > 1 else 1.0)
    thickness = THICKNESS * layout.em / layout.height
    centers = _centers(layout, grid, scales, length, words) if len(lines) == 1 else _spread(lines)
    for k, (scale, fitted) in enumerate(scales.items()):
        below, above = fitted.share_beyond(values_on(scale, views))
        line = next(i for i, members in enumerate(lines) if k in members)
        bottom = (layout.foot - line * _line_height(words, layout.em)) / layout.height - 1.5 * thickness
        bar = figure.colorbar(
            ScalarMappable(Normalize(*fitted.limits or ()), fitted.colormap),
            cax=figure.add_axes((centers[k] - 0.5 * length, bottom, length, thickness)),
            orientation="horizontal",
            extend=ENDS[below > 0.0, above > 0.0],
            extendfrac=0.04,
            ticks=_ticks(fitted, length * layout.width / layout.em),
        )
        bar.outline.set(edgecolor=QUIET, linewidth=points(OUTLINE * layout.em))
        distance = points(DISTANCE * layout.em)
        bar.ax.tick_params(labelsize=points(TICK_FONT * layout.em), length=distance, pad=distance)
        bar.set_label("\n".join(words[k]), size=points(TICK_FONT * layout.em), labelpad=distance)


def _words(scale: ColorScale, fitted: ColorScale, views: Sequence[SurfaceView]) -> list[str]:
    """Lines below a bar: what it measures, and how much lies beyond it."""
    beyond = 100.0 * sum(fitted.share_beyond(values_on(scale, views)))
    how = "were clipped" if fitted.clipped else "lie beyond"
    return [*filter(None, [fitted.title, f"{beyond:.2g} % of the values {how}" if beyond else ""])]


def _line_height(words: Sequence[Sequence[str]], em: float) -> int:
    """Pixels from a line of bars to the next."""
    return round((BAR_BAND + WORD_BAND * any(len(below) > 1 for below in words)) * em)


def _extents(words: Sequence[Sequence[str]], em: float) -> list[float]:
    """Width of what is written below each bar with the gap to the next, in pixels."""
    return [(LETTER * TICK_FONT * max(map(len, below), default=0) + GAP) * em for below in words]


def _lines(words: Sequence[Sequence[str]], width: float, em: float) -> list[range]:
    """Bars of each line: as few lines as the words below them allow, all of the same length but for the last."""
    if not words:
        return []
    most = max(min(int(width / max(_extents(words, em))), len(words)), 1)
    each = -(-len(words) // -(-len(words) // most))
    return [range(first, min(first + each, len(words))) for first in range(0, len(words), each)]


def _spread(lines: Sequence[range]) -> list[float]:
    """Middle of each bar, those of a line evenly spread."""
    return [(k + 0.5) / len(line) for line in lines for k in range(len(line))]


def _ticks(scale: ColorScale, length: float) -> Any:
    """Places of at most six numbers that do not run together on a bar so many times as long as the text is high."""
    from matplotlib.ticker import MaxNLocator

    low, high = scale.limits or (0.0, 1.0)
    for most in range(MOST_TICKS, 1, -1):
        found = MaxNLocator(most, steps=[1, 2, 2.5, 5, 10])
        places = found.tick_values(low, high)
        longest = max(len(f"{place:.6g}") for place in places)
        if (places[1] - places[0]) / (high - low) * length >= DIGIT * (longest + 1):
            return found
    return MaxNLocator(1)


def _centers(layout: Layout, grid: Grid, scales: Scales, length: float, words: Sequence[Sequence[str]]) -> list[float]:
    """Middle of each bar of one line: under the views that use it, or evenly spread where bars or words would meet."""
    users: dict[ColorScale, list[float]] = {scale: [] for scale in scales}
    for row in grid:
        for j, view in enumerate(row):
            if view.is_scalar:
                users[view.scale].append(layout.middle(j, len(row)))
    centers = [0.5 * (min(middles) + max(middles)) for middles in users.values()]
    halves = [0.5 * max(1.1 * length, extent / layout.width) for extent in _extents(words, layout.em)]
    placed = sorted(zip(centers, halves, strict=True))
    inside = all(half <= center <= 1.0 - half for center, half in placed)
    if not inside or any(b - a < left + right for (a, left), (b, right) in pairwise(placed)):
        return _spread([range(len(centers))])
    return centers
