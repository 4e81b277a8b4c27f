"""A table of ratios: colours on either side of 1, bold and stars where they belong."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.figures.contrast import LEAST, contrast, ink_on
from surfexp_studies.smoothing.ratio_table import cell_colors, ratio_table


def cell(pixels: np.ndarray, row: int, column: int) -> np.ndarray:
    """Mean colour of the left edge of a cell of two by two, where no text stands."""
    height, width = pixels.shape[:2]
    top, left, right = round(0.46 * height), round(0.24 * width), round(0.99 * width)
    y = top + round((row + 0.5) * (0.9 * height - top) / 2)
    x = left + round((column + 0.06) * (right - left) / 2)
    return pixels[y - 2 : y + 2, x : x + 4].reshape(-1, 3).mean(axis=0)


def test_less_is_blue_and_more_is_red() -> None:
    ratios = np.array([[0.5, 2.0], [1.0, np.nan]])
    drawn = ratio_table(ratios, np.array([[1.0, -1.0], [0.0, 0.0]]), ["a", "b"], ["first one", "second"], width=900)
    assert drawn.pixels.shape[1] == 900 > drawn.pixels.shape[0]
    less, more, same = (cell(drawn.pixels, *place) for place in ((0, 0), (0, 1), (1, 0)))
    assert less[2] > less[0] + 20 and more[0] > more[2] + 20
    assert np.ptp(same) < 8


def test_what_failed_has_a_star_and_shapes_have_to_fit() -> None:
    words = {"rows": ["a"], "columns": ["b"]}
    sure = ratio_table(np.array([[0.5]]), np.array([[0.0]]), **words)
    failed = ratio_table(np.array([[0.5]]), np.array([[np.nan]]), **words)
    assert sure.svg != failed.svg
    other = ratio_table(np.array([[0.5]]), np.array([[0.0]]), rows=["a"], columns=["another"])
    assert not np.array_equal(sure.pixels, other.pixels)
    with pytest.raises(ValueError, match=r"ratios are \(1, 1\) and verdicts \(1, 1\) for 2 rows"):
        ratio_table(np.ones((1, 1)), np.ones((1, 1)), ["a", "b"], ["c"])


def test_the_words_of_every_cell_can_be_read() -> None:
    cells = cell_colors(np.geomspace(0.05, 20.0, 200)[None])[0]
    assert min(contrast(ink_on(cell), cell) for cell in cells) >= LEAST
    # dark words on all of them cannot
    assert min(contrast("#222222", cell) for cell in cells) < 3.0
