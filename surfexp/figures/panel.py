"""Panels: a grid of surfaces of one scale, with titles and one colour bar for each distinct quantity."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from surfexp.figures.camera import fit_camera, projected_extent, unit_camera
from surfexp.figures.colormap import ColorScale
from surfexp.figures.figure import Figure
from surfexp.figures.render import SurfaceView, draw
from surfexp.figures.typography import canvas, drawn, points

Grid = list[list[SurfaceView]]

# lengths as shares of the panel's width
FONT, TITLE_BAND, HEAD_BAND, BAR_BAND, BAR_HEIGHT, MARGIN = 0.0135, 0.027, 0.036, 0.066, 0.010, 0.012
# a cell is at most this many times as high as it is wide
TALLEST = 1.25
WIDEST_BAR = 0.26


@dataclass(frozen=True)
class Layout:
    """Where things are, in pixels from the top left corner."""

    width: int
    column: int
    row_heights: tuple[int, ...]
    head: int
    title_bands: tuple[int, ...]
    foot: int
    scale: float

    def row_top(self, row: int) -> int:
        """Top of the pictures of a row, under its titles."""
        return self.head + sum(self.row_heights[:row]) + sum(self.title_bands[: row + 1])

    @property
    def height(self) -> int:
        """Height of the panel."""
        return self.head + sum(self.row_heights) + sum(self.title_bands) + self.foot


def surface_panel(
    views: Sequence[SurfaceView] | Sequence[Sequence[SurfaceView]],
    *,
    width: int = 1600,
    title: str = "",
    caption: str = "",
    field_of_view: float = 0.0,
    supersampling: int = 2,
) -> Figure:
    """Surfaces side by side, all at the same number of pixels per unit of length.

    Views whose colour scales are equal share their limits and one bar below the grid, which has pointed ends where values
    lie beyond it.

    Parameters
    ----------
    views : sequence, or sequence of sequences, of SurfaceView
        One row, or rows.
    width : int
        In pixels, at least 200; the height follows from the surfaces.

    Returns
    -------
    Figure
        `notes` state the share of values beyond a bar and the vertices without a value.

    Raises
    ------
    ValueError
        If there is no view, or the width too small.
    """
    grid: Grid = [[row] if isinstance(row, SurfaceView) else list(row) for row in views]
    if views and isinstance(views[0], SurfaceView):
        grid = [[view for row in grid for view in row]]
    scenes = [scene for row in grid for scene in row]
    if not scenes or width < 200:
        raise ValueError(f"panel has {len(scenes)} views and {width} pixels of width; at least 1 and 200 are needed")
    scales = _fitted_scales(scenes)
    layout = _layout(grid, width, bool(title), bool(scales), field_of_view)
    with canvas(width, layout.height) as figure:
        _write(figure, layout, grid, title)
        _draw_bars(figure, layout, grid, scales)
        pixels = drawn(figure)
    for i, row in enumerate(grid):
        for j, scene in enumerate(row):
            size = (layout.column, layout.row_heights[i])
            camera = fit_camera(scene.mesh, scene.view, size, field_of_view, scale=layout.scale)
            fitted = replace(scene, scale=scales.get(scene.scale, scene.scale))
            top, left = layout.row_top(i), _left(layout, row, j)
            pixels[top : top + size[1], left : left + size[0]] = draw(fitted, camera, supersampling)
    return Figure(pixels, caption, title, notes=_notes(scenes, scales))


def _values_on(scale: ColorScale, scenes: Sequence[SurfaceView]) -> NDArray[np.float64]:
    return np.concatenate([s.values for s in scenes if s.values is not None and s.is_scalar and s.scale == scale])


def _fitted_scales(scenes: Sequence[SurfaceView]) -> dict[ColorScale, ColorScale]:
    """Each distinct scale with the limits that all its views share, in order of appearance."""
    distinct = dict.fromkeys(scene.scale for scene in scenes if scene.is_scalar)
    return {scale: scale.fitted(_values_on(scale, scenes)) for scale in distinct}


def _layout(grid: Grid, width: int, has_head: bool, has_bars: bool, field_of_view: float) -> Layout:
    columns = max(len(row) for row in grid)
    column = width // columns
    gap = round(MARGIN * width)
    extents = [
        [projected_extent(unit_camera(scene.mesh, scene.view, field_of_view), scene.mesh) for scene in row] for row in grid
    ]
    scale = min(
        min((column - 2 * gap) / max(w, 1e-300), TALLEST * column / max(h, 1e-300)) for row in extents for w, h in row
    )
    return Layout(
        width=width,
        column=column,
        row_heights=tuple(int(np.ceil(scale * max(h for _, h in row))) + 2 * gap for row in extents),
        head=round(HEAD_BAND * width) if has_head else 0,
        title_bands=tuple(round(TITLE_BAND * width) if any(s.title for s in row) else 0 for row in grid),
        foot=round(BAR_BAND * width) if has_bars else 0,
        scale=scale,
    )


def _left(layout: Layout, row: Sequence[SurfaceView], j: int) -> int:
    """Left border of the j-th picture of a row; short rows are centred."""
    return (layout.width - len(row) * layout.column) // 2 + j * layout.column


def _write(figure: Any, layout: Layout, grid: Grid, title: str) -> None:
    size, height = points(FONT * layout.width), layout.height
    if title:
        y = 1.0 - 0.6 * layout.head / height
        figure.text(MARGIN, y, title, fontsize=1.15 * size, fontweight="bold", ha="left", va="center")
    for i, row in enumerate(grid):
        y = 1.0 - (layout.row_top(i) - 0.45 * layout.title_bands[i]) / height
        for j, scene in enumerate(row):
            x = (_left(layout, row, j) + 0.5 * layout.column) / layout.width
            figure.text(x, y, scene.title, fontsize=size, ha="center", va="center")


def _bar_centers(layout: Layout, grid: Grid, scales: Sequence[ColorScale]) -> list[float]:
    """Middle of each bar: under the views that use it, or evenly spread where the bars would meet."""
    columns: dict[ColorScale, list[float]] = {scale: [] for scale in scales}
    for row in grid:
        for j, scene in enumerate(row):
            if scene.is_scalar:
                columns[scene.scale].append((_left(layout, row, j) + 0.5 * layout.column) / layout.width)
    centers = [0.5 * (min(c) + max(c)) for c in columns.values()]
    ordered = sorted(centers)
    if any(b - a < 1.15 * _bar_length(len(scales), layout) for a, b in zip(ordered, ordered[1:], strict=False)):
        return [(k + 0.5) / len(centers) for k in range(len(centers))]
    return centers


def _bar_length(count: int, layout: Layout) -> float:
    """Share of the width; the same for all bars of a panel."""
    return min(WIDEST_BAR, 0.8 * layout.column / layout.width if count > 1 else WIDEST_BAR, 0.8 / count)


def _draw_bars(figure: Any, layout: Layout, grid: Grid, scales: dict[ColorScale, ColorScale]) -> None:
    size = points(0.92 * FONT * layout.width)
    length, thickness = _bar_length(len(scales), layout), BAR_HEIGHT * layout.width / layout.height
    bottom = (layout.foot - (MARGIN + BAR_HEIGHT) * layout.width * 0.7) / layout.height
    scenes = [scene for row in grid for scene in row]
    for (scale, fitted), center in zip(scales.items(), _bar_centers(layout, grid, list(scales)), strict=True):
        axes = figure.add_axes((center - 0.5 * length, bottom, length, thickness))
        below, above = fitted.share_beyond(_values_on(scale, scenes))
        extend = {(False, False): "neither", (True, False): "min", (False, True): "max", (True, True): "both"}
        bar = figure.colorbar(
            ScalarMappable(Normalize(*fitted.limits), fitted.colormap),
            cax=axes,
            orientation="horizontal",
            extend=extend[below > 0.0, above > 0.0],
            extendfrac=0.04,
            ticks=MaxNLocator(5, steps=[1, 2, 2.5, 5, 10]),
        )
        bar.outline.set_visible(False)
        bar.ax.tick_params(labelsize=size, length=points(0.003 * layout.width), pad=points(0.002 * layout.width))
        bar.set_label(fitted.title, size=size, labelpad=points(0.002 * layout.width))


def _notes(scenes: Sequence[SurfaceView], scales: dict[ColorScale, ColorScale]) -> tuple[str, ...]:
    notes = []
    for scale, fitted in scales.items():
        below, above = fitted.share_beyond(_values_on(scale, scenes))
        if below + above > 0.0:
            name = fitted.label or "the values"
            notes.append(f"{100.0 * (below + above):.2g} % of {name} lie beyond the colour bar and take its end colours.")
    for scene in scenes:
        if scene.missing:
            where = f" of {scene.title!r}" if scene.title else ""
            notes.append(f"{scene.missing} vertices{where} have no value; their faces are drawn grey.")
    return tuple(notes)
