"""Isospectral drums, section 4.2 and figure 4.1."""

from typing import Literal

import numpy as np
from pydantic import Field

from surfexp.spectrum.isospectral_comparison import TILE_SHAPES, compare_drums
from surfexp.spectrum.isospectral_drums import GORDON_WEBB_WOLPERT_VALUES
from surfexp.spectrum.transplantation_pairs import GORDON_WEBB_WOLPERT, transplantation_pairs
from surfexp.statistics.statistic import Statistic
from surfexp.workflow.registry import Options, register

NAMED = "gordon_webb_wolpert"


class IsospectralDrums(Options):
    """Which pair, which tile, and how it is meshed."""

    pair: Literal["gordon_webb_wolpert", "0", "1", "2", "3", "4", "5", "6"] = Field(
        "gordon_webb_wolpert", description="by name, or the number of one of the seven pairs"
    )
    tile: Literal["right_isosceles", "scalene", "obtuse"] = Field("right_isosceles", description="shape of the tile")
    divisions: int = Field(14, ge=2, le=100, description="divisions of a side of the tile")
    grading: float = Field(2.0, ge=1, le=6, description="exponent that draws nodes to the corners; 1: uniform")
    order: Literal[1, 2, 3] = Field(2, description="order of the elements")
    count: int = Field(20, ge=2, le=500, description="eigenvalues")
    boundary: Literal["dirichlet", "neumann"] = Field("dirichlet", description="condition on the boundary")


@register("statistic", "isospectral_drums")
def isospectral_drums(options: IsospectralDrums) -> Statistic:
    """Spectra and nodal counts of two drums of seven equal tiles that sound the same."""
    named = options.pair == NAMED
    pair = GORDON_WEBB_WOLPERT if named else transplantation_pairs()[int(options.pair)]
    found = compare_drums(
        pair,
        TILE_SHAPES[options.tile],
        options.divisions,
        options.count,
        options.order,
        options.grading,
        options.boundary,
    )
    differing = found.differing_modes
    metrics = {
        "spectral_difference": found.spectral_difference,
        "complete": float(found.first.complete and found.second.complete),
        "first_differing_mode": float(differing[0]) if len(differing) else 0.0,
        "differing_modes": float(len(differing)),
        "congruent": float(found.outline_difference < 1e-6),
        "degrees_of_freedom": float(len(found.first.vectors)),
    }
    if named and options.tile == "right_isosceles" and options.boundary == "dirichlet":
        known = np.array(GORDON_WEBB_WOLPERT_VALUES)[: options.count]
        metrics["error_to_published"] = float(np.abs(found.first.values[: len(known)] / known - 1.0).max())
    columns = {
        "mode": np.arange(1.0, options.count + 1.0),
        "first spectrum": found.first.values,
        "second spectrum": found.second.values,
        "first counts": found.first_counts.astype(np.float64),
        "second counts": found.second_counts.astype(np.float64),
    }
    name = "Gordon-Webb-Wolpert drums" if named else f"drums of pair {options.pair}"
    return Statistic(f"{name}, {options.tile.replace('_', ' ')} tile", columns, metrics=metrics)
