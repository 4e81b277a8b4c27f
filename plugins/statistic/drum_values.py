"""Eigenvalues of the drums of figure 4.1 to nine digits."""

from collections.abc import Sequence
from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.statistics.statistic import Statistic
from surfexp.studies.drums.drum_values import drum_values
from surfexp.studies.drums.isospectral_comparison import TILE_SHAPES
from surfexp.studies.drums.isospectral_drums import GORDON_WEBB_WOLPERT_VALUES
from surfexp.studies.drums.transplantation_pairs import GORDON_WEBB_WOLPERT

# modes 9 and 21 are those of the tile itself, reflected: 5 pi^2 / 4 and twice that
EXACT = {8: 1.25 * np.pi**2, 20: 2.5 * np.pi**2}


METRICS = {
    "error_to_published": Metric("largest relative error to the published values", better="lower"),
    "error_to_exact": Metric("largest relative error to the values known exactly", better="lower"),
    "largest_estimate": Metric("largest estimated error of the extrapolation", better="lower"),
    "finest_mesh_error": Metric("largest relative error of the finest mesh", better="lower"),
    "degrees_of_freedom": Metric("unknowns of the finest mesh"),
}


@register("statistic", "drum_values", metrics=METRICS, defaults_of=drum_values)
def drum_values_statistic(
    *,
    count: Annotated[int, Field(ge=10, le=100, description="eigenvalues")],
    divisions: Annotated[
        Sequence[int], Field(description="even divisions of a side of the tile, three meshes or more")
    ],
    grading: Annotated[float, Field(ge=1, le=6, description="exponent that draws nodes to the corners")],
) -> Statistic:
    """First Dirichlet values of the Gordon-Webb-Wolpert drum by cubic elements on graded meshes, extrapolated."""
    tile = TILE_SHAPES["right_isosceles"]
    found = drum_values(GORDON_WEBB_WOLPERT.first, tile, count, tuple(divisions), grading)
    known = np.array(GORDON_WEBB_WOLPERT_VALUES)
    finest = np.abs(found.computed[-1] / found.values - 1.0)
    exact = [abs(found.values[mode] / value - 1.0) for mode, value in EXACT.items() if mode < count]
    metrics = {
        "error_to_published": float(np.abs(found.values[: len(known)] / known - 1.0).max()),
        "error_to_exact": float(max(exact)) if exact else 0.0,
        "largest_estimate": float(found.estimates.max()),
        "finest_mesh_error": float(finest.max()),
        "degrees_of_freedom": float(found.degrees_of_freedom[-1]),
    }
    columns = {
        "mode": np.arange(1.0, count + 1.0),
        "value": found.values,
        "estimated error": found.estimates,
        "error of the finest mesh": finest,
    }
    return Statistic("values of the Gordon-Webb-Wolpert drum", columns, metrics=metrics)
