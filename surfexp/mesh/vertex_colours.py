"""Colours of vertices: three maps red, green and blue that belong together."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from surfexp.contract.arrays import Floats

COLOURS = ("red", "green", "blue")
ALPHA = "alpha"
NAMES = ("color", "colour", "rgb")
# colours of 0 to 1 may leave it a little where they were smoothed
LARGEST_SHARE = 1.5


def colour_of(maps: Mapping[str, Floats], name: str) -> Floats | None:
    """Return red, green and blue of a surface side by side, where its maps have them and `name` asks for the colour.

    Parameters
    ----------
    maps : dict of str to (n,) float64
    name : str
        "color", "colour" or "rgb"; a map of that name comes first.

    Returns
    -------
    (n, 3) float64, optional

    Examples
    --------
    >>> colour_of({"red": np.zeros(2), "green": np.ones(2), "blue": np.ones(2)}, "color")
    array([[0., 1., 1.],
           [0., 1., 1.]])
    """
    if name not in NAMES or name in maps or not set(COLOURS) <= set(maps):
        return None
    return np.stack([maps[channel] for channel in COLOURS], axis=1)


def are_bytes(values: Floats) -> bool:
    """Whether all values are whole numbers from 0 to 255, of which files of colours are made."""
    return bool(((values >= 0) & (values <= 255) & (values == np.rint(values))).all())


def as_shares(values: Floats) -> Floats:
    """Return colours from 0 to 1, those from 0 to 255 divided by 255.

    Parameters
    ----------
    values : (n, 3) float64
        NaN where there is no colour.
    """
    return values / 255.0 if (values > LARGEST_SHARE).any() else values


def as_bytes(values: Floats) -> Floats:
    """Return colours from 0 to 255, those from 0 to 1 times 255; whole numbers where only the digits of a file are missing.

    Parameters
    ----------
    values : (n, 3) float64
    """
    if (values < 0).any() or (values > 1).any():
        return values
    scaled = 255.0 * values
    whole = np.rint(scaled)
    return whole if (np.abs(scaled - whole) < 0.13).all() else scaled
