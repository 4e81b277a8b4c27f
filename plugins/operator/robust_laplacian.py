"""The tufted Laplacian of Sharp and Crane, a pair of matrices."""

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.operators.matrix_operator import robust_laplacian
from surfexp.operators.surface_operator import SurfaceOperator


class RobustLaplacian(Options):
    """How far triangles are kept from degenerating."""

    mollify: float = Field(1e-5, ge=0, lt=1, description="smallest slack of a triangle, over the mean edge length")


@register("operator", "robust_laplacian")
def robust_laplacian_operator(options: RobustLaplacian, *, surface: Surface) -> SurfaceOperator:
    """Intrinsic Delaunay on a tufted cover, for meshes of any quality: eigenproblems and heat flow, no gradients."""
    return robust_laplacian(surface.mesh, options.mollify)
