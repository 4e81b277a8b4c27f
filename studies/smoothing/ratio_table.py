"""A table of ratios in colours: blue below 1, red above, bold where the difference is more than chance."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.figures.axes import FONT
from surfexp.figures.contrast import ink_on
from surfexp.figures.figure import Figure
from surfexp.figures.typography import canvas, drawn, points, vector

FARTHEST = 4.0
ROW, HEAD, FOOT = 2.1, 4.4, 1.0
PALE = 0.7


def ratio_table(
    ratios: Floats,
    verdicts: Floats,
    rows: Sequence[str],
    columns: Sequence[str],
    *,
    title: str = "",
    caption: str = "",
    width: int = 1100,
) -> Figure:
    """Draw (r, c) ratios.

    Parameters
    ----------
    ratios : (r, c) float64
        NaN leaves the cell empty.
    verdicts : (r, c) float64
        1 or -1 where the ratio is bold, 0 where it is not, NaN where something failed.
    rows, columns : sequence of str
        Names.

    Raises
    ------
    ValueError
        If shapes do not fit.
    """
    if ratios.shape != (len(rows), len(columns)) or verdicts.shape != ratios.shape:
        raise ValueError(
            f"ratios are {ratios.shape} and verdicts {verdicts.shape} for {len(rows)} rows and {len(columns)} columns"
        )
    em = FONT * width
    height = round(em * (ROW * len(rows) + HEAD + FOOT + (1.6 if title else 0.0)))
    with canvas(width, height) as figure:
        top = (HEAD + (1.6 if title else 0.0)) * em / height
        axes = figure.add_axes((0.24, FOOT * em / height, 0.75, 1.0 - top - FOOT * em / height))
        axes.grid(visible=False)
        cells = cell_colors(ratios)
        axes.imshow(cells, aspect="auto")
        for i, j in np.argwhere(np.isfinite(ratios)):
            failed = np.isnan(verdicts[i, j])
            text = f"{ratios[i, j]:.2f}" + ("*" if failed else "")
            bold = not failed and verdicts[i, j] != 0
            weight = "bold" if bold else "normal"
            axes.text(
                j, i, text, ha="center", va="center", color=ink_on(cells[i, j]), fontsize=points(em), fontweight=weight
            )
        axes.set_xticks(range(len(columns)), [name.replace(" ", "\n") for name in columns])
        axes.xaxis.tick_top()
        axes.set_yticks(range(len(rows)), rows)
        axes.tick_params(labelsize=points(0.9 * em), length=0.0)
        axes.tick_params(axis="x", labelsize=points(0.75 * em))
        axes.spines[:].set_visible(False)
        if title:
            figure.text(0.01, 1.0 - 0.6 * em / height, title, fontsize=points(1.1 * em), fontweight="bold", va="top")
        pixels, svg = drawn(figure), vector(figure)
    return Figure(pixels, caption, title, svg=svg)


def cell_colors(ratios: Floats) -> Floats:
    """Return (r, c, 3) colours of ratios, pale red above 1 and pale blue below, white where there is none.

    Parameters
    ----------
    ratios : (r, c) float64
    """
    from matplotlib import colormaps

    reach = np.log(FARTHEST)
    place = 0.5 + 0.5 * np.clip(np.log(ratios) / reach, -1.0, 1.0)
    full = np.asarray(colormaps["RdBu_r"](np.nan_to_num(place, nan=0.5)), dtype=np.float64)[..., :3]
    return np.where(np.isfinite(ratios)[..., None], 1.0 - PALE + PALE * full, 1.0)
