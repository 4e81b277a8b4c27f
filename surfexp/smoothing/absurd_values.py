"""Values of a map that lie so far from all others that they are no measurements."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats

# how many times the range of all other values the empty interval before them is as long
FARNESS = 100.0
# of all values, how many different ones may be absurd: a code for no data is one value, however many vertices have it
DIFFERENT = 0.01


def absurd_values(values: Floats) -> NDArray[np.bool_]:
    """Return where a map has values that an empty interval of 100 times the range of the others separates from them.

    The others are more than half of the vertices and not all equal. Where the far ones take more different values than 1 + 1 %
    of the vertices, they are the second level of a map with little noise, and no code for what is unknown. What is left is
    looked at again: of -9999 and 3.4e38 in one map both are found.

    Parameters
    ----------
    values : (n,) float64
        Finite.

    Returns
    -------
    (n,) bool
    """
    absurd = np.zeros(len(values), dtype=bool)
    most = 1 + int(DIFFERENT * len(values))
    while True:
        kept = np.flatnonzero(~absurd)
        order = kept[np.argsort(values[kept], kind="stable")]
        half = len(values) // 2 + 1
        # halves, so that differences of the largest numbers are finite
        ascending = 0.5 * values[order]
        gaps, last = np.diff(ascending) / FARNESS, len(order) - half
        lower, upper = ascending[half - 1 : -1] - ascending[0], ascending[-1] - ascending[1 : last + 1]
        steps = np.diff(values[order]) > 0
        under = 1 + np.cumsum(steps) - steps
        over = 1 + steps.sum() - np.cumsum(steps)
        above = np.flatnonzero((gaps[half - 1 :] > lower) & (lower > 0) & (over[half - 1 :] <= most)) + half - 1
        below = np.flatnonzero((gaps[:last] > upper) & (upper > 0) & (under[:last] <= most))
        if len(above):
            absurd[order[above[0] + 1 :]] = True
        elif len(below):
            absurd[order[: below[-1] + 1]] = True
        else:
            return absurd


def refuse_absurd_values(values: Floats, vertices: NDArray[np.int64] | None = None) -> None:
    """Raise ValueError if a map has absurd values, with how many, the first of them, and what to do.

    Parameters
    ----------
    values : (n,) or (n, c) float64
        Finite.
    vertices : (n,) int64, optional
        What the vertices are called; default: their places.

    Raises
    ------
    ValueError
        See `absurd_values`.
    """
    for channel in values.reshape(len(values), -1).T:
        absurd = absurd_values(channel)
        if absurd.any():
            first, rest = int(np.argmax(absurd)), channel[~absurd]
            name = first if vertices is None else int(vertices[first])
            raise ValueError(
                f"map has {int(absurd.sum())} of {len(channel)} values far from all others, such as {channel[first]:g} at "
                f"vertex {name}; the others lie in [{rest.min():g}, {rest.max():g}]: set them to NaN where they mean "
                "no data, or clip them"
            )
