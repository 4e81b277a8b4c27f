"""Nodal counts against the number of the mode, section 4.5."""

from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.signature import Signature
from surfexp.statistics.statistic import Statistic
from surfexp.studies.spectra.nodal_trend import nodal_trend

METRICS = {
    "mean_ratio": Metric("mean of count over number, upper half of the modes"),
    "largest_ratio": Metric("largest count over number, upper half of the modes"),
    "exponent": Metric("exponent of the growth of the counts"),
    "slope": Metric("factor of the growth of the counts"),
    "over_rectangle": Metric("mean ratio over that of the rectangle, 4 / pi^2"),
    "pleijel": Metric("Pleijel's bound of the upper limit"),
    "smooth_ratio": Metric("mean ratio of a rectangle without fluctuations"),
    "over_smooth": Metric("mean ratio over that of a rectangle without fluctuations"),
}


@register("statistic", "nodal_trend", metrics=METRICS)
def nodal_trend_statistic(
    surface: Surface,
    signature: Signature,
    *,
    part: Annotated[str, Field(description="part of the signature; empty: the signature itself")] = "",
) -> Statistic:
    """Mean of count over mode number, its exponent, and how far it is below the bounds of Courant and Pleijel."""
    mesh = surface.mesh
    ends = mesh.vertices[mesh.edges[mesh.edge_face_counts == 1]]
    perimeter = float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum())
    return nodal_trend(signature.part(part), surface.name, mesh.area, perimeter)
