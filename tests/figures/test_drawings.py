"""Pages of skeletons and of grids: what stands where."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from surfexp.drawings.patch_grid_drawing import _draw_maps
from surfexp.drawings.skeleton_drawing import SkeletonView, skeleton_panel
from surfexp.figures.typography import canvas
from surfexp.mesh.shapes.icosphere import icosphere

MESH = icosphere(1).mesh


@pytest.mark.parametrize(("count", "columns"), [(1, 1), (2, 2), (3, 3), (4, 4), (5, 4), (9, 4)])
def test_up_to_three_stand_side_by_side_and_more_in_four_columns(count: int, columns: int) -> None:
    views = [SkeletonView(MESH)] * count
    plain, told = (skeleton_panel(views, columns=asked, width=240).pixels for asked in (0, columns))
    assert np.array_equal(plain, told)


def test_titles_take_room_only_where_there_are_some() -> None:
    heights = {
        (rows, bool(title)): len(skeleton_panel([SkeletonView(MESH, title=title)] * rows, columns=1, width=200).pixels)
        for rows in (1, 2)
        for title in ("", "a sphere")
    }
    one, two = (heights[rows, False] for rows in (1, 2))
    band = heights[1, True] - one
    assert band > 20 and heights[2, True] - two == 2 * band
    cell = skeleton_panel([SkeletonView(MESH)], columns=1, width=200, title="").pixels
    rows_with_ink = np.flatnonzero((cell < 255).any(axis=(1, 2)))
    above, below = rows_with_ink[0], len(cell) - 1 - rows_with_ink[-1]
    assert two - one == one - 8 and below - above == 16  # two gaps of eight pixels below, no room for titles above


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
