"""Panels: surfaces side by side at one scale, with titles and one colour bar for each distinct quantity."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from surfexp.figures.camera import fit_camera
from surfexp.figures.color_bar import Scales, bars_height, draw_bars, fitted_scales, values_on
from surfexp.figures.figure import Figure
from surfexp.figures.legend import draw_legend, legend_height, names_of, without_names
from surfexp.figures.panel_layout import MARGIN, Grid, Layout, arrange, text_size
from surfexp.figures.render import SurfaceView, draw
from surfexp.figures.typography import canvas, drawn, points, saved


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

    Views whose colour scales are equal share their limits and one bar below the grid.

    Parameters
    ----------
    views : sequence, or sequence of sequences, of SurfaceView
        One row, or rows.
    width : int
        In pixels, at least 200; the height follows from the surfaces.
    field_of_view, supersampling
        As in `fit_camera` and `draw`.

    Returns
    -------
    Figure
        The caption ends with the share of values beyond a bar; `notes` state the vertices without a value.

    Raises
    ------
    ValueError
        If a row is empty, or the width too small.
    """
    return _composed(_rows(views), width, title, caption, field_of_view, supersampling)[0]


def vector_panel(
    views: Sequence[SurfaceView] | Sequence[Sequence[SurfaceView]], form: Literal["svg", "pdf"], *, width: int = 1600
) -> bytes:
    """The panel of `surface_panel` as a drawing: surfaces as pictures, words and colour bars as lines and letters.

    Parameters
    ----------
    views : sequence, or sequence of sequences, of SurfaceView
        One row, or rows.
    form : "svg" or "pdf"
    width : int
        In pixels of the pictures.

    Raises
    ------
    ValueError
        As `surface_panel`.
    """
    return _composed(_rows(views), width, "", "", 0.0, 2, form)[1]


def _composed(
    grid: list[list[SurfaceView]],
    width: int,
    title: str,
    caption: str,
    field_of_view: float,
    supersampling: int,
    form: Literal["", "svg", "pdf"] = "",
) -> tuple[Figure, bytes]:
    """Return the panel in pixels, and as a drawing where one is asked for."""
    if not grid or not all(grid) or width < 200:
        counts = [len(row) for row in grid]
        raise ValueError(
            f"panel has rows of {counts} views and width {width}; at least 1 view and 200 pixels are needed"
        )
    everything = [view for row in grid for view in row]
    scales = fitted_scales(everything)
    beyond, em, names = _beyond(everything, scales), text_size(width), names_of(everything)
    foot = bars_height(scales, everything, width, em)
    layout = arrange(grid, width, bool(title), foot + legend_height(names, width, em), field_of_view)
    with canvas(width, layout.height) as figure:
        _write(figure, layout, grid, title)
        draw_bars(figure, layout, grid, scales)
        draw_legend(figure, layout, names)
        pixels = drawn(figure)
        for i, row in enumerate(grid):
            for j, view in enumerate(row):
                size = (layout.columns[j], layout.rows[i])
                camera = fit_camera(view.mesh, view.view, size, field_of_view, scale=layout.scale)
                fitted = replace(view, scale=scales.get(view.scale, view.scale))
                top, left = layout.top(i), layout.left(j, len(row))
                picture = draw(fitted, camera, supersampling)
                pixels[top : top + size[1], left : left + size[0]] = picture
                if form:
                    _put(figure, picture, (left / width, 1.0 - (top + size[1]) / layout.height))
        drawing = saved(figure, form) if form else b""
    return Figure(pixels, " ".join([caption, *beyond]).strip(), title, notes=_notes(everything)), drawing


def _put(figure: Any, picture: NDArray[np.uint8], corner: tuple[float, float]) -> None:
    """Put a picture into a figure, pixel for pixel, its lower left corner at a place in shares of the figure."""
    width, height = figure.get_size_inches() * figure.dpi
    place = figure.add_axes((*corner, picture.shape[1] / width, picture.shape[0] / height))
    place.imshow(picture, aspect="auto", interpolation="none")
    place.set_axis_off()


def _rows(views: Sequence[SurfaceView] | Sequence[Sequence[SurfaceView]]) -> list[list[SurfaceView]]:
    flat = [view for view in views if isinstance(view, SurfaceView)]
    return [flat] if flat else [list(row) for row in views if not isinstance(row, SurfaceView)]


def _write(figure: Any, layout: Layout, grid: Grid, title: str) -> None:
    size, height = points(layout.em), layout.height
    y = 1.0 - 0.6 * layout.head / height
    figure.text(MARGIN, y, title, fontsize=1.15 * size, fontweight="bold", ha="left", va="center")
    for i, row in enumerate(grid):
        y = 1.0 - (layout.top(i) - 0.45 * layout.title_bands[i]) / height
        for j, view in enumerate(row):
            figure.text(layout.middle(j, len(row)), y, view.title, fontsize=size, ha="center", va="center")


def _beyond(views: Sequence[SurfaceView], scales: Scales) -> list[str]:
    """Return a sentence for each bar that does not hold all values."""
    found = []
    for scale, fitted in scales.items():
        beyond = 100.0 * sum(fitted.share_beyond(values_on(scale, views)))
        if beyond > 0.0:
            bar = f"the bar {fitted.label!r}" if fitted.label else "the bar"
            found.append(f"{beyond:.2g} % of the values lie beyond {bar} and take its end colours.")
    return found


def _notes(views: Sequence[SurfaceView]) -> tuple[str, ...]:
    notes = []
    for view in views:
        if view.missing:
            where = f" of {view.title!r}" if view.title else ""
            lacking = "value; their faces are" if view.labels is None else "label; they are"
            notes.append(f"{view.missing} vertices{where} have no {lacking} drawn grey.")
    # two views of one surface say the same
    return (*dict.fromkeys(notes), *without_names(views))
