"""Nodal counts of the torus by separation, section 4.5."""

from typing import Annotated

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.spectrum.torus_modes import torus_modes
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


@register("statistic", "torus_trend", metrics=METRICS, defaults_of=torus_modes)
def torus_trend_statistic(
    *,
    count: Annotated[int, Field(ge=20, le=20000, description="modes after the constant one")] = 300,
    major_radius: Annotated[float, Field(gt=0, description="radius of the centre line")],
    minor_radius: Annotated[float, Field(gt=0, description="radius of the tube, less than that of the centre line")],
) -> Statistic:
    """Trend of the exact nodal counts of the separated eigenfunctions of a torus of revolution."""
    counts = torus_modes(count + 1, major_radius, minor_radius)[1]
    return nodal_trend(counts[1:], "torus, separated modes")
