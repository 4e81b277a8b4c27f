"""Geodesic distance from a vertex as a feature."""

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.skeleton.fast_marching import fast_marching
from surfexp.skeleton.feature import Feature


class GeodesicDistance(Options):
    """From where."""

    source: int | None = Field(None, ge=0, description="vertex; default: one of the two that lie far apart")


@register("feature", "geodesic_distance", metrics={"largest": Metric("largest distance", "unit of length")})
def geodesic_distance_feature(options: GeodesicDistance, *, surface: Surface) -> Feature:
    """Distance along the surface from a vertex, by fast marching."""
    source = options.source
    if source is None:
        source = int(np.argmax(fast_marching(surface.mesh, np.array([0]))))
    values = fast_marching(surface.mesh, np.array([source]))
    return Feature(values, f"distance from vertex {source}", surface.unit, {"largest": float(values.max())})
