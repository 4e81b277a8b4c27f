"""Distance to the boundary as a feature."""

from typing import Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.skeleton.boundary_distance import boundary_distance
from surfexp.skeleton.feature import Feature


class BoundaryDistance(Options):
    """By which method."""

    method: Literal["fast_marching", "exact", "heat"] = Field("fast_marching", description="how D of (5.6) is found")
    halvings: int = Field(3, ge=0, le=6, description="halvings of the boundary's edges, for exact distances")


@register("feature", "boundary_distance", metrics={"largest": Metric("largest distance", "unit of length")})
def boundary_distance_feature(options: BoundaryDistance, *, surface: Surface) -> Feature:
    """Geodesic distance to the boundary (5.6), from which flux and Hamilton-Jacobi skeleton are made."""
    values = boundary_distance(surface.mesh, options.method, options.halvings)
    return Feature(values, "distance to the boundary", surface.unit, {"largest": float(values.max())})
