"""Nodal counts of the torus by separation, section 4.5."""

from pydantic import Field

from surfexp.spectrum.torus_modes import torus_modes
from surfexp.statistics.nodal_trend import nodal_trend
from surfexp.statistics.statistic import Statistic
from surfexp.workflow.registry import Options, register


class TorusTrend(Options):
    """The torus, and how many of its modes."""

    count: int = Field(300, ge=20, le=20000, description="modes after the constant one")
    major_radius: float = Field(1.0, gt=0, description="radius of the centre line")
    minor_radius: float = Field(0.4, gt=0, description="radius of the tube, less than that of the centre line")


@register("statistic", "torus_trend")
def torus_trend_statistic(options: TorusTrend) -> Statistic:
    """Trend of the exact nodal counts of the separated eigenfunctions of a torus of revolution."""
    counts = torus_modes(options.count + 1, options.major_radius, options.minor_radius)[1]
    return nodal_trend(counts[1:], "torus, separated modes")
