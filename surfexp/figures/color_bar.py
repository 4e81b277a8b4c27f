"""Colour bars below a grid of pictures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.figures.colormap import ColorScale
from surfexp.figures.panel_layout import Grid, Layout
from surfexp.figures.render import SurfaceView
from surfexp.figures.typography import QUIET, points

# longest bar as a share of the panel's width; the rest in multiples of the text's size
LONGEST, THICKNESS, DISTANCE, OUTLINE, TICK_FONT = 0.26, 0.75, 0.22, 0.045, 0.92
# intervals of a bar, and the room of a digit in multiples of the text's size
MOST_TICKS, DIGIT = 5, 0.6
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


def draw_bars(figure: Any, layout: Layout, grid: Grid, scales: Scales) -> None:
    """One bar for each scale, in the foot of a panel; an end is pointed where values lie beyond it."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    views = [view for row in grid for view in row]
    length = min(
        LONGEST, 0.8 / max(len(scales), 1), 0.85 * min(layout.columns) / layout.width if len(scales) > 1 else 1.0
    )
    thickness = THICKNESS * layout.em / layout.height
    bottom = layout.foot / layout.height - 1.5 * thickness
    for (scale, fitted), center in zip(scales.items(), _centers(layout, grid, scales, length), strict=True):
        below, above = fitted.share_beyond(values_on(scale, views))
        bar = figure.colorbar(
            ScalarMappable(Normalize(*fitted.limits or ()), fitted.colormap),
            cax=figure.add_axes((center - 0.5 * length, bottom, length, thickness)),
            orientation="horizontal",
            extend=ENDS[below > 0.0, above > 0.0],
            extendfrac=0.04,
            ticks=_ticks(fitted, length * layout.width / layout.em),
        )
        bar.outline.set(edgecolor=QUIET, linewidth=points(OUTLINE * layout.em))
        distance = points(DISTANCE * layout.em)
        bar.ax.tick_params(labelsize=points(TICK_FONT * layout.em), length=distance, pad=distance)
        beyond = 100.0 * (below + above)
        how = "were clipped" if fitted.clipped else "lie beyond"
        words = [fitted.title, f"{beyond:.2g} % of the values {how}" if beyond else ""]
        bar.set_label("\n".join(filter(None, words)), size=points(TICK_FONT * layout.em), labelpad=distance)


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


def _centers(layout: Layout, grid: Grid, scales: Scales, length: float) -> list[float]:
    """Middle of each bar: under the views that use it, or evenly spread where bars would meet."""
    users: dict[ColorScale, list[float]] = {scale: [] for scale in scales}
    for row in grid:
        for j, view in enumerate(row):
            if view.is_scalar:
                users[view.scale].append(layout.middle(j, len(row)))
    centers = [0.5 * (min(middles) + max(middles)) for middles in users.values()]
    if any(b - a < 1.1 * length for a, b in pairwise(sorted(centers))):
        return [(k + 0.5) / len(centers) for k in range(len(centers))]
    return centers
