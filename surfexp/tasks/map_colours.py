"""Which colours maps are drawn in, where nobody says."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from surfexp.contract.arrays import Floats

CENTRAL = (1.0, 99.0)
SEQUENTIAL, DIVERGING = "viridis", "RdBu_r"
# the smaller side of 0 over the larger one, from which on a map is of both signs
OF_BOTH_SIGNS = 0.2


def central_ends(fields: Sequence[Floats]) -> tuple[float, float] | None:
    """Return the 1st and 99th percentile of all values, as far from 0 on both sides if they are of both signs.

    Nothing where no two values differ.
    """
    known = np.concatenate([np.empty(0), *(np.ravel(field) for field in fields)])
    known = known[np.isfinite(known)]
    if not known.size:
        return None
    low, high = (float(end) for end in np.percentile(known, CENTRAL))
    if low < 0 < high and min(-low, high) > OF_BOTH_SIGNS * max(-low, high):
        high = max(-low, high)
        low = -high
    return (low, high) if low < high else None


def usual_colormap(fields: Sequence[Floats], limits: tuple[float, float] | None) -> str:
    """Return a map of colours for fields that share them: a diverging one where its middle means 0.

    Parameters
    ----------
    fields : sequence of (n,) or (n, c) float64
    limits : (float, float), optional
        Ends of the colours; those of `central_ends` if not given.
    """
    ends = limits or (central_ends(fields) if all(field.ndim == 1 for field in fields) else None)
    return DIVERGING if ends is not None and ends[0] == -ends[1] else SEQUENTIAL
