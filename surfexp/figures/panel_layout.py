"""Where the pictures, titles and bars of a panel are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate

import numpy as np

from surfexp.figures.camera import projected_extent, unit_camera
from surfexp.figures.render import SurfaceView

Grid = Sequence[Sequence[SurfaceView]]

# size of the text as a share of the panel's width, and its least number of pixels
FONT, SMALLEST_FONT = 0.0135, 14.0
# heights of bands in multiples of the text's size
TITLE_BAND, HEAD_BAND, BAR_BAND = 2.0, 2.7, 4.9
# mean width of a letter, in the same
LETTER = 0.56
# a line below a bar that says what lies beyond it
WORD_BAND = 1.3
# empty space around a surface as a share of the panel's width
MARGIN = 0.010
# a row is at most this many times as high as the mean column is wide
TALLEST = 1.25
# a column is at least this share of the mean column, so that its title has room
NARROWEST = 0.6


@dataclass(frozen=True)
class Layout:
    """A grid of pictures in pixels.

    Parameters
    ----------
    columns, rows : tuple of int
        Widths and heights of the pictures.
    head : int
        Height of the band with the panel's title.
    title_bands : tuple of int
        Heights of the bands with the titles of each row.
    foot : int
        Height of the band with the colour bars and the legend.
    scale : float
        Pixels per unit of length, the same for all surfaces.
    width : int
        Of the panel.
    em : float
        Size of the text.
    """

    columns: tuple[int, ...]
    rows: tuple[int, ...]
    head: int
    title_bands: tuple[int, ...]
    foot: int
    scale: float
    width: int
    em: float

    @property
    def height(self) -> int:
        """Height of the panel."""
        return self.head + sum(self.rows) + sum(self.title_bands) + self.foot

    def top(self, row: int) -> int:
        """Upper border of the pictures of a row, which is under its titles."""
        return self.head + sum(self.rows[:row]) + sum(self.title_bands[: row + 1])

    def left(self, column: int, count: int) -> int:
        """Left border of a picture in a row of so many; short rows are centred."""
        return (self.width - sum(self.columns[:count])) // 2 + sum(self.columns[:column])

    def middle(self, column: int, count: int) -> float:
        """Middle of a picture as a share of the panel's width."""
        return (self.left(column, count) + 0.5 * self.columns[column]) / self.width


def text_size(width: int) -> float:
    """Return the size of the text in a panel of a width, in pixels."""
    return max(FONT * width, SMALLEST_FONT)


def arrange(grid: Grid, width: int, has_head: bool, foot: int, field_of_view: float) -> Layout:
    """The layout in which the surfaces are largest at equal scale; columns are as wide as what they show."""
    extents = [
        [projected_extent(unit_camera(view.mesh, view.view, field_of_view), view.mesh) for view in row] for row in grid
    ]
    count, gap = max(len(row) for row in grid), round(MARGIN * width)
    widest = np.array([max(row[j][0] for row in extents if j < len(row)) for j in range(count)])
    tallest = max(extent[1] for row in extents for extent in row)
    shares = np.maximum(widest, max(NARROWEST * float(widest.mean()), 1e-300))
    borders = np.rint(width * np.array([0.0, *accumulate(shares / shares.sum())])).astype(int)
    columns = np.diff(borders)
    scale = float(np.min((columns - 2 * gap) / np.maximum(widest, 1e-300)))
    scale = min(scale, TALLEST * width / count / max(tallest, 1e-300))
    em = text_size(width)
    return Layout(
        columns=tuple(columns.tolist()),
        rows=tuple(int(np.ceil(scale * max(h for _, h in row))) + 2 * gap for row in extents),
        head=round(HEAD_BAND * em) if has_head else 0,
        title_bands=tuple(round(TITLE_BAND * em) if any(view.title for view in row) else 0 for row in grid),
        foot=foot,
        scale=scale,
        width=width,
        em=em,
    )
