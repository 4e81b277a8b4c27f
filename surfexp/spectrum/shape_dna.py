"""Shape DNA: the first eigenvalues as a signature, and ways to make it independent of size."""

from __future__ import annotations

from typing import Literal

import numpy as np

from surfexp.contract.arrays import Floats

Normalisation = Literal["raw", "area", "volume", "first", "slope"]
NORMALISATIONS = ("raw", "area", "volume", "first", "slope")


def shape_dna(
    values: Floats,
    normalisation: Normalisation = "area",
    area: float | None = None,
    volume: float | None = None,
    reweighted: bool = False,
) -> Floats:
    """Return the eigenvalues after the zero ones as a signature (Reuter, Wolter and Peinecke 2006).

    Parameters
    ----------
    values : (k,) float64
        Increasing, with the zero value of each component or without.
    normalisation : "raw", "area", "volume", "first" or "slope"
        Times the area (scale-free); times volume^(2/3); over the first value; over the slope of the line through the
        origin that fits lambda_i by i best, which is 4 pi / A in the limit.
    area, volume : float, optional
        Needed by their normalisations.
    reweighted : bool
        Divide lambda_i by i, so that all entries weigh about the same.

    Raises
    ------
    ValueError
        If the normalisation is unknown or its size is missing or not positive.
    """
    positive = np.asarray(values)[np.asarray(values) > 1e-6 * values[-1]]
    numbers = np.arange(1.0, len(positive) + 1.0)
    if normalisation not in NORMALISATIONS:
        raise ValueError(f"normalisation {normalisation!r} is unknown, choose one of {', '.join(NORMALISATIONS)}")
    size = {"area": area, "volume": volume}.get(normalisation, 1.0)
    if size is None or size <= 0:
        raise ValueError(f"normalisation {normalisation!r} needs a positive {normalisation}, it is {size}")
    factor = {
        "raw": 1.0,
        "area": size,
        "volume": size ** (2.0 / 3.0),
        "first": 1.0 / positive[0],
        "slope": float((numbers @ numbers) / (numbers @ positive)),
    }[normalisation]
    return np.asarray(factor * positive / (numbers if reweighted else 1.0))
