"""Flux and flux weights as features."""

from typing import Annotated

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.skeleton.boundary_distance import boundary_distance
from surfexp.skeleton.feature import Feature
from surfexp.skeleton.flux import flux, flux_weights, skeleton_points, weight_far_from_boundary

METRICS = {
    "least_flux": Metric("least flux"),
    "largest_flux": Metric("largest flux"),
    "skeleton_points": Metric("points of the skeleton"),
    "smallest_weight": Metric("smallest weight"),
    "largest_weight": Metric("largest weight"),
    "weight_on_skeleton": Metric("mean weight far from the boundary over the mean of all"),
}


@register("feature", "flux", metrics=METRICS, defaults_of=flux_weights)
def flux_feature(
    surface: Surface,
    *,
    alpha: Annotated[
        float | None, Field(gt=0, le=10, description="exponent of (5.10) for the weight; default: the flux")
    ] = None,
    contrast: Annotated[float, Field(gt=0, le=20, description="factor in the exponent; 1 as published")],
) -> Feature:
    """Flux of the gradient of the distance to the boundary (5.9), or the weight (5.10)."""
    distance = boundary_distance(surface.mesh)
    values, name = flux(surface.mesh, distance), "flux"
    metrics = {"least_flux": float(values.min()), "largest_flux": float(values.max())}
    metrics["skeleton_points"] = float(len(skeleton_points(surface.mesh, values)))
    if alpha is not None:
        values, name = flux_weights(values, alpha, contrast), f"weight, alpha {alpha:g}"
        metrics |= {"smallest_weight": float(values.min()), "largest_weight": float(values.max())}
        metrics["weight_on_skeleton"] = weight_far_from_boundary(surface.mesh, values, distance)
    return Feature(values, name, "", metrics)
