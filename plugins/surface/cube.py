"""The cube of figure 2.7."""

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.shapes.cube import cube
from surfexp.mesh.surface import Surface


class Cube(Options):
    """Size, resolution and position of the cube."""

    cells: int = Field(32, ge=1, le=400, description="squares along a side")
    side: float = Field(2.0, gt=0, description="side length")
    rotation: tuple[float, float, float] = Field((0.0, 0.0, 0.0), description="degrees about x, then y, then z")


@register("surface", "cube")
def cube_surface(options: Cube) -> Surface:
    """Cube of 6 cells^2 + 2 vertices, turned by any angles."""
    return cube(**dict(options))
