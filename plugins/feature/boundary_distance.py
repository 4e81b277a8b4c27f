"""Distance to the boundary as a feature."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.skeleton.boundary_distance import boundary_distance
from surfexp.skeleton.feature import Feature


@register(
    "feature",
    "boundary_distance",
    metrics={"largest": Metric("largest distance", "unit of length")},
    defaults_of=boundary_distance,
)
def boundary_distance_feature(
    surface: Surface,
    *,
    method: Annotated[Literal["fast_marching", "exact", "heat"], Field(description="how D of (5.6) is found")],
    halvings: Annotated[int, Field(ge=0, le=6, description="halvings of the boundary's edges, for exact distances")],
) -> Feature:
    """Geodesic distance to the boundary (5.6), from which flux and Hamilton-Jacobi skeleton are made."""
    values = boundary_distance(surface.mesh, method, halvings)
    return Feature(values, "distance to the boundary", surface.unit, {"largest": float(values.max())})
