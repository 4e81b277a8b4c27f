"""A row of joined tori."""

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.shapes.genus_surface import genus_surface
from surfexp.mesh.surface import Surface


class GenusSurface(Options):
    """The genus, and the resolution."""

    genus: int = Field(2, ge=1, le=8, description="number of holes")
    count: int = Field(8000, ge=3000, le=400000, description="number of vertices")


@register("surface", "genus_surface")
def genus_surface_surface(options: GenusSurface) -> Surface:
    """Closed surface of a given genus: a row of joined tori."""
    return genus_surface(**dict(options))
