"""A flat rectangle."""

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.shapes.rectangle import rectangle
from surfexp.mesh.surface import Surface


class Rectangle(Options):
    """Vertices and sides."""

    n_x: int = Field(61, ge=2, le=4000, description="vertices along x")
    n_y: int = Field(41, ge=2, le=4000, description="vertices along y")
    width: float = Field(1.449137674618944, gt=0, description="length along x; default: the root of 2.1")
    height: float = Field(1.0, gt=0, description="length along y")


@register("surface", "rectangle")
def rectangle_surface(options: Rectangle) -> Surface:
    """Flat rectangle with alternating diagonals, of irrational aspect by default."""
    return rectangle(**dict(options))
