"""A developable strip, for lengths and poses that are known."""

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.shapes.strip import strip
from surfexp.mesh.surface import Surface


class Strip(Options):
    """A jagged strip rolled onto a cylinder."""

    length: float = Field(60.0, gt=0, le=1e6, description="length of the flat strip")
    width: float = Field(12.0, gt=0, le=1e6, description="width of the flat strip")
    edge_length: float = Field(0.63, gt=0, le=1e5, description="side of the triangles")
    jag: float = Field(0.25, ge=0, le=0.5, description="deviation of the edge's vertices, in edge lengths")
    bend: float = Field(0.5, ge=0, le=1.5, description="largest turning angle of the bent strip, radians")
    arch: float = Field(0.0, ge=0, le=3, description="turning of the middle line within the flat strip, radians")
    seed: int = Field(0, ge=0, description="seed of the jagged edge")


@register("surface", "strip")
def strip_surface(options: Strip) -> Surface:
    """A strip of known length with jagged edges, bent in space without stretching."""
    return strip(**dict(options))
