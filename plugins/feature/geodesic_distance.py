"""Geodesic distance from a vertex as a feature."""

from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.skeleton.fast_marching import fast_marching
from surfexp.skeleton.feature import Feature


@register("feature", "geodesic_distance", metrics={"largest": Metric("largest distance", "unit of length")})
def geodesic_distance_feature(
    surface: Surface,
    *,
    source: Annotated[int | None, Field(ge=0, description="vertex; default: one of the two that lie far apart")] = None,
) -> Feature:
    """Distance along the surface from a vertex, by fast marching."""
    start = source
    if start is None:
        start = int(np.argmax(fast_marching(surface.mesh, np.array([0]))))
    values = fast_marching(surface.mesh, np.array([start]))
    return Feature(values, f"distance from vertex {start}", surface.unit, {"largest": float(values.max())})
