"""The anisotropic operator of chapter 5."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.operators.fem import fem
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.skeleton.boundary_distance import boundary_distance
from surfexp.skeleton.flux import flux, flux_weights, weighted_operator

METRICS = {
    "smallest_weight": Metric("smallest weight of a triangle"),
    "largest_weight": Metric("largest weight of a triangle"),
}


@register("operator", "flux_weighted", metrics=METRICS, defaults_of=(boundary_distance, flux_weights))
def flux_weighted_operator(
    surface: Surface,
    *,
    alpha: Annotated[float, Field(gt=0, le=10, description="exponent of (5.10); smaller is nearer to two values")],
    contrast: Annotated[
        float, Field(gt=0, le=20, description="factor in the exponent; 1 as published, where w lies in 1/e..e")
    ],
    method: Annotated[Literal["fast_marching", "exact", "heat"], Field(description="how D of (5.6) is found")],
) -> SurfaceOperator:
    """The operator div(w grad) with the flux weights (5.10), larger near the skeleton; needs a patch with a boundary."""
    found = flux(surface.mesh, boundary_distance(surface.mesh, method))
    weights = flux_weights(found, alpha, contrast)
    return weighted_operator(fem(surface.mesh), weights, name=f"flux weighted, alpha {alpha:g}")
