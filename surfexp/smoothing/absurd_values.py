"""Values of a map that lie so far from all others that they are no measurements."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats

# how many times the range of all other values the empty interval before them is as long
FARNESS = 100.0
# of all values: so few may differ among themselves, and of more than that half are one value
FEW = 0.01


def absurd_values(values: Floats) -> NDArray[np.bool_]:
    """Return where a map has values that an empty interval of 100 times the range of the others separates from them.

    The others are more than half of the vertices and not all equal. Half of what is far is one value, as a code is, or it is
    at most a hundredth of the map: the upper of two levels is neither. What is left is looked at again: of -9999 and 3.4e38 in
    one map both are found.

    Parameters
    ----------
    values : (n,) float64
        Finite.

    Returns
    -------
    (n,) bool
    """
    absurd = np.zeros(len(values), dtype=bool)
    while True:
        kept = np.flatnonzero(~absurd)
        order = kept[np.argsort(values[kept], kind="stable")]
        half = len(values) // 2 + 1
        # halves, so that differences of the largest numbers are finite
        ascending = 0.5 * values[order]
        gaps, last = np.diff(ascending) / FARNESS, len(order) - half
        lower, upper = ascending[half - 1 : -1] - ascending[0], ascending[-1] - ascending[1 : last + 1]
        above = np.flatnonzero((gaps[half - 1 :] > lower) & (lower > 0)) + half - 1
        below = np.flatnonzero((gaps[:last] > upper) & (upper > 0))
        ends = [order[gap + 1 :] for gap in above] + [order[: gap + 1] for gap in below[::-1]]
        found = next((end for end in ends if _no_measurements(values[end], len(values))), None)
        if found is None:
            return absurd
        absurd[found] = True


def _no_measurements(far: Floats, count: int) -> bool:
    """Whether values far from the others are a code, or so few that they may be anything."""
    return bool(len(far) <= FEW * count or 2 * np.unique_counts(far).counts.max() >= len(far))


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
