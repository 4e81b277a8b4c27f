"""The Hamilton-Jacobi skeleton."""

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.skeleton.boundary_distance import boundary_distance
from surfexp.skeleton.hamilton_jacobi import hamilton_jacobi_skeleton
from surfexp.skeleton.skeleton import Skeleton


class HamiltonJacobi(Options):
    """Which ends stay."""

    threshold: float = Field(-0.35, lt=0, ge=-1, description="ends of curves with flux below this stay")


METRICS = {
    "length": Metric("length of all arcs", "unit of length"),
}


@register("skeleton", "hamilton_jacobi", metrics=METRICS)
def hamilton_jacobi_plugin(options: HamiltonJacobi, *, surface: Surface) -> Skeleton:
    """Hamilton-Jacobi skeleton (figures 5.1 and 5.5): flux-ordered thinning that keeps topology."""
    distance = boundary_distance(surface.mesh)
    return hamilton_jacobi_skeleton(surface.mesh, distance, options.threshold, surface.name)
