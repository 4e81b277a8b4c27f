"""The published gradient (1.26)."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.operators.vertex_averaged import vertex_averaged

register(
    "operator",
    "vertex_averaged",
    summary="The published gradient and divergence, averaged over the first ring (1.26); not adjoint, so no energy is minimised.",
    options={"tangent": Field(description="project fields to the tangent plane of each vertex")},
)(vertex_averaged)
