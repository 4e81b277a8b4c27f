"""Maps of several columns: a series that is shown column by column, or the colours of each vertex."""

from __future__ import annotations

from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.figures.labelling import Labelling
from surfexp.mesh.surface import Surface
from surfexp.mesh.vertex_colours import are_bytes, as_shares, colour_of

# of a map, in a picture
MOST_COLUMNS = 6


def columns_of(given: Any) -> list[Floats]:
    """Return the columns of a map that has several and holds no colours; none of anything else."""
    array = getattr(given, "values", given)
    if not isinstance(array, np.ndarray) or array.ndim != 2 or array.shape[1] < 2 or is_color(array):
        return []
    return [*array.T]


def is_color(array: Floats) -> bool:
    """Whether (n, 3) numbers are red, green and blue: all in 0..1, or whole numbers up to 255."""
    known = array[np.isfinite(array)] if array.dtype.kind == "f" else array
    if array.shape[1:] != (3,) or not known.size:
        return False
    return bool(known.min() >= 0.0 and known.max() <= 1.0) or are_bytes(known)


def own_colors(surface: Surface) -> Floats | None:
    """Return (n, 3) colours in 0..1 that a surface carries as its maps "red", "green" and "blue", as scans do."""
    found = colour_of(surface.scalars, "color")
    return None if found is None else np.clip(as_shares(found), 0.0, 1.0)


def flat_colors(colors: Floats) -> Labelling:
    """Return (n, 3) colours in 0..1 as labels of at most 255 colours near to them, each named as in CSS."""
    from PIL import Image

    known = np.asarray(np.isfinite(colors).all(axis=1))
    pixels = np.rint(255.0 * np.where(known[:, None], colors, 0.0)).astype(np.uint8)
    near = Image.fromarray(pixels[None]).quantize(255, method=Image.Quantize.MEDIANCUT, kmeans=1)
    palette = np.array(near.getpalette(), dtype=np.float64).reshape(-1, 3)
    index = np.where(known, np.asarray(near, dtype=np.int64).ravel(), -1)
    names = tuple("#" + "".join(f"{round(channel):02x}" for channel in color) for color in palette)
    return Labelling(index, names, palette / 255.0)


def spread_over(count: int, most: int) -> list[int]:
    """Return at most so many of the numbers below count, the first and the last among them, evenly spread.

    Examples
    --------
    >>> spread_over(24, 6)
    [0, 5, 9, 14, 18, 23]
    """
    return np.unique(np.rint(np.linspace(0, count - 1, min(count, most))).astype(int)).tolist()
