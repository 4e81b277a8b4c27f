"""The sphere with nearly equilateral triangles."""

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface


class Icosphere(Options):
    """Size and resolution of the sphere."""

    levels: int = Field(4, ge=0, le=8, description="subdivisions of the icosahedron")
    radius: float = Field(1.0, gt=0, description="radius")


@register("surface", "icosphere")
def icosphere_surface(options: Icosphere) -> Surface:
    """Sphere of 10 * 4^levels + 2 vertices, all exactly on it."""
    return icosphere(**dict(options))
