"""Colours of words that can be read on their background, by the contrast ratio of WCAG 2.1."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.figures.typography import INK

Color = str | Sequence[float] | Floats
# what WCAG asks of words
LEAST = 4.5
SHARES = np.array([0.2126, 0.7152, 0.0722])


def luminance(color: Color) -> float:
    """Return the relative luminance of a colour of the display, 0 for black and 1 for white.

    Parameters
    ----------
    color : str or (3,) float
        A name of matplotlib's, or red, green and blue in 0..1.
    """
    from matplotlib.colors import to_rgb

    channels = np.array(to_rgb(color if isinstance(color, str) else tuple(color)))
    linear = np.where(channels <= 0.04045, channels / 12.92, ((channels + 0.055) / 1.055) ** 2.4)
    return float(SHARES @ linear)


def contrast(one: Color, other: Color) -> float:
    """Return the contrast ratio of two colours, 1 to 21.

    Examples
    --------
    >>> contrast("white", "black")
    21.0
    """
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


def ink_on(background: Color) -> str:
    """Return the colour of words on a background: that of all words where it can be read, else black or white."""
    if contrast(INK, background) >= LEAST:
        return INK
    return max("black", "white", key=lambda color: contrast(color, background))


def ink_like(color: Color) -> tuple[float, float, float]:
    """Return a colour darkened, in the same hue, until it has the contrast of words on white."""
    from matplotlib.colors import to_rgb

    red, green, blue = to_rgb(color if isinstance(color, str) else tuple(color))
    for share in np.linspace(1.0, 0.0, 51).tolist():
        darker = (share * red, share * green, share * blue)
        if contrast(darker, "white") >= LEAST:
            return darker
    return (0.0, 0.0, 0.0)
