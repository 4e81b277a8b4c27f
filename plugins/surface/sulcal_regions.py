"""A cortex with its sulcal regions, figure 6.4."""

from dataclasses import replace
from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.studies.sulci.sulcal_regions import sulcal_regions

METRICS = {
    "regions": Metric("number of sulcal regions"),
    "sulcal share": Metric("share of the area in sulcal regions"),
}


@register("surface", "sulcal_regions", metrics=METRICS, defaults_of=sulcal_regions)
def sulcal_regions_surface(
    original: Surface,
    *,
    smoothness: Annotated[float, Field(gt=0, le=100, description="weight of the boundary, without unit")],
    smallest_share: Annotated[float, Field(ge=0, lt=1, description="smallest region as a share of the surface's area")],
) -> Surface:
    """Another surface with its sulcal regions as labels from 1, largest first, and 0 on gyri."""
    regions = sulcal_regions(original.mesh, smoothness, smallest_share)
    inside = regions >= 0
    areas = original.mesh.vertex_areas
    metrics = {"regions": float(regions.max() + 1), "sulcal share": float(areas[inside].sum() / areas.sum())}
    labels = (regions + 1).astype(np.int64)
    return replace(original, metrics={**original.metrics, **metrics}, truth=replace(original.truth, labels=labels))
