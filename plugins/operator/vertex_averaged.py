"""The published gradient (1.26)."""

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.operators.vertex_averaged import vertex_averaged


class VertexAveraged(Options):
    """Whether the average is made tangent."""

    tangent: bool = Field(False, description="project fields to the tangent plane of each vertex")


@register("operator", "vertex_averaged")
def vertex_averaged_operator(options: VertexAveraged, *, surface: Surface) -> SurfaceOperator:
    """The published gradient and divergence, averaged over the first ring (1.26); not adjoint, so no energy is minimised."""
    return vertex_averaged(surface.mesh, tangent=options.tangent)
