"""A number over the stops of a slider, as a page draws it beside the surfaces."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats

# ticks of a logarithmic axis within each factor of ten, and how many intervals the other axis has at most
WITHIN_TEN, INTERVALS = (1.0, 3.0), 6


@dataclass(frozen=True, eq=False)
class Curve:
    """A number at each stop, with a band.

    Parameters
    ----------
    places : (k,) float64
        Of the stops on a logarithmic axis, growing.
    values, errors : (k,) float64
        The band is a standard error to both sides.
    least : int
        The stop with a mark.
    words : tuple of str
        What is said of each stop, in lines.
    x_label, y_label : str
    solved : (l,) float64
        Places on the axis that are no interpolation.
    highest : float
        End of the axis of the values, where they go beyond it.
    """

    places: Floats
    values: Floats
    errors: Floats
    least: int
    words: tuple[str, ...]
    x_label: str
    y_label: str
    solved: Floats
    highest: float = np.inf

    def described(self) -> dict[str, Any]:
        """Return what a script draws: numbers, limits and ticks.

        Returns
        -------
        dict
        """
        lower, upper = self.values - self.errors, self.values + self.errors
        ticks = even_ticks(min(float(lower.min()), 0.0), min(float(upper.max()), self.highest))
        return {
            "places": self.places.tolist(),
            "bands": np.column_stack([self.values, lower, upper]).tolist(),
            "least": self.least,
            "words": list(self.words),
            "labels": [self.x_label, self.y_label],
            "solved": self.solved.tolist(),
            "ticks": [tens(float(self.places[0]), float(self.places[-1])), ticks],
            "limits": [
                [float(self.places[0]), float(self.places[-1])],
                [min(float(lower.min()), 0.0), min(float(upper.max()), self.highest)],
            ],
        }


def tens(low: float, high: float) -> list[float]:
    """Return the ticks of a logarithmic axis.

    Examples
    --------
    >>> tens(0.03, 30.0)
    [0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0]
    """
    powers = range(int(np.floor(np.log10(low))), int(np.ceil(np.log10(high))) + 1)
    found = [float(f"{part:g}e{power}") for power in powers for part in WITHIN_TEN]
    return [tick for tick in found if low * (1.0 - 1e-9) <= tick <= high * (1.0 + 1e-9)]


def even_ticks(low: float, high: float) -> list[float]:
    """Return ticks of an axis at equal distances of 1, 2 or 5 times a power of ten.

    Examples
    --------
    >>> even_ticks(-0.03, 1.1)
    [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]
    """
    rough = (high - low) / INTERVALS
    power = 10.0 ** np.floor(np.log10(rough))
    step = next(part * power for part in (1.0, 2.0, 5.0, 10.0) if part * power >= rough)
    places = np.arange(np.ceil(low / step - 1e-9), np.floor(high / step + 1e-9) + 1.0)
    return [float(f"{step * place:.12g}") + 0.0 for place in places]
