"""A developable strip, for lengths and poses that are known."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.strip import strip
from surfexp.mesh.surface import Surface


@register("surface", "strip", defaults_of=strip)
def strip_surface(
    *,
    length: Annotated[float, Field(gt=0, le=1000000.0, description="length of the flat strip")],
    width: Annotated[float, Field(gt=0, le=1000000.0, description="width of the flat strip")],
    edge_length: Annotated[float, Field(gt=0, le=100000.0, description="side of the triangles")],
    jag: Annotated[float, Field(ge=0, le=0.5, description="deviation of the edge's vertices, in edge lengths")],
    bend: Annotated[float, Field(ge=0, le=1.5, description="largest turning angle of the bent strip, radians")],
    arch: Annotated[float, Field(ge=0, le=3, description="turning of the middle line within the flat strip, radians")],
    seed: Annotated[int, Field(ge=0, description="seed of the jagged edge")],
) -> Surface:
    """A strip of known length with jagged edges, bent in space without stretching."""
    return strip(length=length, width=width, edge_length=edge_length, jag=jag, bend=bend, arch=arch, seed=seed)
