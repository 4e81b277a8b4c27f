"""The published gradient (1.26)."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.operators.vertex_averaged import vertex_averaged


@register("operator", "vertex_averaged", defaults_of=vertex_averaged)
def vertex_averaged_operator(
    surface: Surface,
    *,
    tangent: Annotated[bool, Field(description="project fields to the tangent plane of each vertex")],
) -> SurfaceOperator:
    """The published gradient and divergence, averaged over the first ring (1.26); not adjoint, so no energy is minimised."""
    return vertex_averaged(surface.mesh, tangent=tangent)
