"""What filters carry over the medial wall."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.statistics.statistic import Statistic
from surfexp.studies.smoothing.carried_over_mask import carried_over_mask

METRICS = {
    "carried": Metric("share of the map's integral that lies over the mask afterwards", "%", "lower"),
    "error_near_mask": Metric("error of a constant map within 10 mm of the mask", "%", "lower"),
    "error_near_mask_masked": Metric("the same where the part without the mask is smoothed alone", "%", "lower"),
}


@register("statistic", "carried_over_mask", metrics=METRICS)
def carried_over_mask_statistic(
    surface: Surface,
    *,
    filter: Annotated[
        Literal["neighbour_mean", "geodesic_gaussian", "heat_flow"], Field(description="the filter")
    ] = "heat_flow",
    width: Annotated[float, Field(gt=0, le=1000, description="full width at half maximum, mm")] = 10.0,
    map: Annotated[str, Field(min_length=1, description="map that is positive inside the mask")] = "thickness",
) -> Statistic:
    """A constant map with 0 over the mask, smoothed as packages do and on the part alone."""
    if map not in surface.scalars:
        known = ", ".join(surface.scalars) or "none"
        raise ValueError(f"map {map!r} is not on {surface.name}, which has {known}")
    return carried_over_mask(surface.mesh, surface.scalars[map] > 0, filter, width)
