"""The tufted Laplacian of Sharp and Crane, a pair of matrices."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.operators.matrix_operator import robust_laplacian
from surfexp.operators.surface_operator import SurfaceOperator


@register("operator", "robust_laplacian", defaults_of=robust_laplacian)
def robust_laplacian_operator(
    surface: Surface,
    *,
    mollify: Annotated[float, Field(ge=0, lt=1, description="smallest slack of a triangle, over the mean edge length")],
) -> SurfaceOperator:
    """Intrinsic Delaunay on a tufted cover, for meshes of any quality: eigenproblems and heat flow, no gradients."""
    return robust_laplacian(surface.mesh, mollify)
