"""Drawings of grids on patches."""

from __future__ import annotations

import itertools
from types import SimpleNamespace

import numpy as np
import pytest

from surfexp.figures.typography import canvas
from surfexp.mesh.shapes.rectangle import rectangle
from surfexp_studies.skeletons.patch_grid_drawing import _draw_curves, _draw_maps, grid_panel


def test_each_colour_bar_is_as_high_as_its_map_and_beside_it() -> None:
    places, means = (np.linspace(0, 1, 4), np.linspace(0, 1, 3)), (np.ones((4, 3)), np.eye(4, 3))
    with canvas(400, 300) as figure:
        _draw_maps(figure, places, np.eye(4, 3), np.eye(4, 3) > 0, means, ("a", "b"), 1.0, 400)
        boxes = [axes.get_position() for axes in figure.axes]
    maps, bars = boxes[0::2], boxes[1::2]
    assert len(maps) == len(bars) == 3
    for drawn, bar in zip(maps, bars, strict=True):
        assert (bar.y0, bar.y1) == pytest.approx((drawn.y0, drawn.y1)) and drawn.x1 < bar.x0 < drawn.x1 + 0.05
    assert all(upper.y0 > lower.y1 for upper, lower in itertools.pairwise(maps))


@pytest.mark.parametrize("across", [1, 4])
def test_a_grid_on_a_patch_is_drawn_with_what_was_found(across: int) -> None:
    patch = rectangle(13, 7, 2.0, 1.0).mesh
    low, high = patch.vertices.min(axis=0), patch.vertices.max(axis=0)
    u, v = np.linspace(0.1, 0.9, 5), np.linspace(0.0, 1.0, 4)
    points = np.zeros((5, 4, 3))
    points[..., :2] = low[:2] + (high - low)[:2] * np.stack(np.meshgrid(u, v, indexing="ij"), axis=2)
    grid = SimpleNamespace(points=points, v=v)
    places, statistic = (u, np.linspace(0.0, 1.0, across)), np.linspace(-3.0, 3.0, 5 * across).reshape(5, across)
    means = np.ones((5, across)), np.full((5, across), 2.0)
    drawings = [
        grid_panel(patch, grid, places, statistic, found, means, names=("a", "b"), quantity="width", width=400)
        for found in (statistic > 9.0, statistic > 1.0)
    ]
    plain, told = (drawing.pixels for drawing in drawings)
    assert plain.shape == told.shape and plain.shape[1] == 400 and (plain != told).any()
    half = plain.shape[1] * 55 // 100
    assert np.array_equal(plain[:, :half], told[:, :half])  # the patch shows t, the right side what was found
    red, blue = ((plain[:, :half, a].astype(int) - plain[:, :half, b] > 60).any() for a, b in ((0, 2), (2, 0)))
    assert red and blue


def test_curves_are_two_and_squares_say_where_something_was_found() -> None:
    u, means = np.linspace(0, 1, 4), (np.ones((4, 3)), np.full((4, 3), 2.0))
    for found in (np.zeros(4, dtype=bool), np.array([False, True, True, False])):
        with canvas(400, 300) as figure:
            axes = figure.add_subplot()
            _draw_curves(axes, u, means, found, ("a", "b"), "width", 400)
            lines = {str(line.get_label()): line for line in axes.get_lines()}
        assert list(lines) == ["a", "b"] + ["found"] * bool(found.any())
        assert (lines["a"].get_ydata() == 1.0).all() and (lines["b"].get_ydata() == 2.0).all()
        if found.any():
            assert np.array_equal(lines["found"].get_xdata(), u[found])
            assert (np.asarray(lines["found"].get_ydata()) >= 2.0).all()
