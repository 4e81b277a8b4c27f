"""The Hamilton-Jacobi skeleton."""

from typing import Annotated

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.skeleton.boundary_distance import boundary_distance
from surfexp.skeleton.hamilton_jacobi import hamilton_jacobi_skeleton
from surfexp.skeleton.skeleton import Skeleton

METRICS = {
    "length": Metric("length of all arcs", "unit of length"),
}


@register("skeleton", "hamilton_jacobi", metrics=METRICS, defaults_of=hamilton_jacobi_skeleton)
def hamilton_jacobi_plugin(
    surface: Surface,
    *,
    threshold: Annotated[float, Field(lt=0, ge=-1, description="ends of curves with flux below this stay")],
) -> Skeleton:
    """Hamilton-Jacobi skeleton (figures 5.1 and 5.5): flux-ordered thinning that keeps topology."""
    distance = boundary_distance(surface.mesh)
    return hamilton_jacobi_skeleton(surface.mesh, distance, threshold, surface.name)
