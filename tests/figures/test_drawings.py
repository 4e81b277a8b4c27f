"""Pages of skeletons and of grids: what stands where."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.drawings.skeleton_drawing import SkeletonView, skeleton_panel
from surfexp.mesh.shapes.icosphere import icosphere

MESH = icosphere(1).mesh


@pytest.mark.parametrize(("count", "columns"), [(1, 1), (2, 2), (3, 3), (4, 4), (5, 4), (9, 4)])
def test_up_to_three_stand_side_by_side_and_more_in_four_columns(count: int, columns: int) -> None:
    views = [SkeletonView(MESH)] * count
    plain, told = (skeleton_panel(views, columns=asked, width=240).pixels for asked in (0, columns))
    assert np.array_equal(plain, told)


@pytest.mark.parametrize(("count", "rows"), [(1, 1), (4, 1), (5, 2), (8, 2), (9, 3)])
def test_a_panel_is_as_high_as_its_rows(count: int, rows: int) -> None:
    heights = [len(skeleton_panel([SkeletonView(MESH)] * number, columns=4, width=240).pixels) for number in (count, 1)]
    assert heights[0] - 8 == rows * (heights[1] - 8)  # a gap of eight pixels at the end


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


def test_a_title_stands_in_the_band_above_its_picture() -> None:
    plain, named, empty = (
        skeleton_panel(
            [SkeletonView(MESH, title=title), SkeletonView(MESH, title="right")], columns=2, width=400
        ).pixels
        for title in ("", "left one", " ")
    )
    assert plain.shape == named.shape and np.array_equal(plain, empty)
    changed = np.argwhere((plain != named).any(axis=2))
    picture = np.flatnonzero((plain[:, :200] < 255).any(axis=(1, 2)))[0]
    assert len(changed) > 50
    assert changed[:, 0].max() < picture and changed[:, 1].max() < 200
