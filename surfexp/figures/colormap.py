"""Colour scales: from values to colours, with limits that are stated."""

from __future__ import annotations

from dataclasses import dataclass, replace
from difflib import get_close_matches

import numpy as np

from surfexp.contract.arrays import Floats

# matplotlib's diverging maps: their middle means zero
DIVERGING = frozenset(
    ["PiYG", "PRGn", "BrBG", "PuOr", "RdGy", "RdBu", "RdYlBu", "RdYlGn", "Spectral", "coolwarm", "bwr", "seismic"]
).union(["berlin", "managua", "vanimo"])
# takes the place of a diverging map where the values have one sign
SEQUENTIAL = "viridis"
MISSING = (0.62, 0.62, 0.62)


@dataclass(frozen=True)
class ColorScale:
    """What a colour bar says: a quantity, its unit, its colours and its limits.

    Parameters
    ----------
    label, unit : str
        "mean curvature", "1/mm".
    colormap : str
        Name of a map of matplotlib.
    limits : (float, float), optional
        Values at the two ends. None: found from the values by `fitted`.
    percentiles : (float, float)
        The robust limits that `fitted` takes; (0, 100) is the whole range.
    clipped : bool
        Whether the values were clipped before: those at a limit count as beyond it.

    Raises
    ------
    ValueError
        If the map is unknown, the limits are not increasing, or the percentiles not in 0..100.
    """

    label: str = ""
    unit: str = ""
    colormap: str = "viridis"
    limits: tuple[float, float] | None = None
    percentiles: tuple[float, float] = (1.0, 99.0)
    clipped: bool = False

    def __post_init__(self) -> None:
        import matplotlib

        if self.colormap not in matplotlib.colormaps:
            nearest = get_close_matches(self.colormap, list(matplotlib.colormaps), 1, 0.0)[0]
            raise ValueError(f"colour map {self.colormap!r} is unknown to matplotlib, the nearest name is {nearest!r}")
        if self.limits is not None and not self.limits[0] < self.limits[1]:
            raise ValueError(f"colour limits are {self.limits}, the first must be less than the second")
        if not 0.0 <= self.percentiles[0] < self.percentiles[1] <= 100.0:
            raise ValueError(f"percentiles are {self.percentiles}, choose two increasing numbers in 0..100")

    @property
    def diverging(self) -> bool:
        """Whether the middle colour means zero."""
        return self.colormap.removesuffix("_r") in DIVERGING

    @property
    def title(self) -> str:
        """Label with the unit in brackets."""
        return f"{self.label} ({self.unit})".strip() if self.unit else self.label

    def fitted(self, values: Floats) -> ColorScale:
        """The same scale with limits: its own, or the percentiles of the finite values, symmetric if diverging.

        Of values with one sign no colour may mean zero: they get a sequential map in place of a diverging one. Values that
        are all the same, or none at all, get limits 0.5 to either side, or as far as their digits need.

        Parameters
        ----------
        values : (...) float64

        Returns
        -------
        ColorScale
        """
        if self.limits is not None:
            return self
        finite = values[np.isfinite(values)]
        low, high = np.percentile(finite, self.percentiles) if finite.size else (0.0, 0.0)
        colormap = SEQUENTIAL if self.diverging and (low > 0.0 or high < 0.0) else self.colormap
        if colormap == self.colormap and self.diverging:
            high = max(abs(low), abs(high))
            low = -high
        if not low < high:
            half = max(0.5, float(np.spacing(abs(low))))  # less would be lost in the digits of a large value
            low, high = low - half, high + half
        return replace(self, colormap=colormap, limits=(float(low), float(high)))

    def position(self, values: Floats) -> Floats:
        """Return where values lie between the limits.

        Parameters
        ----------
        values : (...) float64

        Returns
        -------
        (...) float64
            0 to 1, outside beyond the limits; NaN stays.
        """
        low, high = self._known_limits()
        return (np.asarray(values, dtype=float) - low) / (high - low)

    def rgb(self, values: Floats) -> Floats:
        """Return the colours of values.

        Parameters
        ----------
        values : (...) float64

        Returns
        -------
        (..., 3) float64
            In 0..1; the end colours beyond the limits, grey where values are NaN.
        """
        import matplotlib

        colormap = matplotlib.colormaps[self.colormap].with_extremes(bad=MISSING)
        return np.asarray(colormap(self.position(values)))[..., :3]

    def table(self) -> Floats:
        """Return all colours of the map.

        Returns
        -------
        (k, 3) float64
            From the lower limit to the upper.
        """
        import matplotlib

        colormap = matplotlib.colormaps[self.colormap]
        return np.asarray(colormap(np.arange(colormap.N)))[:, :3]

    def share_beyond(self, values: Floats) -> tuple[float, float]:
        """Return how many of the finite values lie below and above the limits.

        Parameters
        ----------
        values : (...) float64

        Returns
        -------
        below, above : float
            Shares.
        """
        low, high = self._known_limits()
        finite = values[np.isfinite(values)]
        if not finite.size:
            return 0.0, 0.0
        if self.clipped:
            return float((finite <= low).mean()), float((finite >= high).mean())
        return float((finite < low).mean()), float((finite > high).mean())

    def _known_limits(self) -> tuple[float, float]:
        if self.limits is None:
            raise ValueError(f"colour scale {self.label!r} has no limits yet, call fitted(values) first")
        return self.limits
