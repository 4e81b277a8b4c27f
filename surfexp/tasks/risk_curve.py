"""What every weight is expected to leave of the noise, and the weight that leaves least."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.contract.summary import Summarized, Summary
from surfexp.mesh.given_numbers import whole_number

AT_AN_END = "The risk is least at an end of the range, {weight:g}: give `weights` that reach further."
HEAVY_TAILS = (
    "The noise has heavy tails: the estimate holds for normal noise, and its least keeps too much of this. Method auto of "
    "`denoise` draws such values in."
)
# a plot leaves out what is worse than the map with all of its noise by more
WORSE = 1.1
HEIGHT = 0.62
WEIGHT_AXIS, RISK_AXIS = "weight", "estimated mean square error / variance of the noise"


@dataclass(frozen=True, eq=False, repr=False)
class RiskCurve(Summarized):
    """Estimated risk of a denoised map at some weights.

    Parameters
    ----------
    weights : (k,) float64
        Growing.
    risks : (k,) float64
        Estimated mean square error by area over the variance of the noise: 1 for the map as it was. Its chance is about
        sqrt(2 / n), so that it may be negative.
    errors : (k,) float64
        Their standard errors. The chance that all weights share is part of each.
    notes : tuple of str
    """

    weights: Floats
    risks: Floats
    errors: Floats
    notes: tuple[str, ...] = ()

    @property
    def best(self) -> int:
        """The place of the least risk."""
        return int(np.argmin(self.risks))

    @property
    def weight(self) -> float:
        """The weight of the least risk."""
        return float(self.weights[self.best])

    def plot(self, width: int = 1000) -> Any:
        """Draw the risk over the weight, with a band of one standard error.

        Parameters
        ----------
        width : int
            In pixels.

        Returns
        -------
        Picture
            `save(path)` writes .png or .svg.

        Raises
        ------
        ImportError
            If the extra `figures` is not installed.
        """
        from surfexp.figures.sweep_plot import sweep_plot  # which needs the extra

        # by name: drawing stands above what is drawn
        pictures = import_module("surfexp.tasks.pictures")
        width = whole_number(width, "width", pictures.NARROWEST, pictures.WIDEST)
        shown = self.risks <= max(WORSE, 2.0 * float(self.risks.min()))
        bands = np.column_stack([self.risks, self.risks - self.errors, self.risks + self.errors])
        least = np.where(np.arange(len(shown)) == self.best, self.risks, np.nan)
        figure = sweep_plot(
            self.weights[shown],
            {"risk": bands[shown], f"least at {self.weight:.3g}": least[shown]},
            x_label=WEIGHT_AXIS,
            y_label=RISK_AXIS,
            log="x",
            band="one standard error",
            size=(width, round(HEIGHT * width)),
        )
        return pictures.Picture(figure)

    def _summary(self) -> Summary:
        facts = {
            "weights": len(self.weights),
            "weight of the least": self.weight,
            "least": float(self.risks[self.best]),
            "standard error": float(self.errors[self.best]),
        }
        return Summary("risk by weight", facts, self.notes)
