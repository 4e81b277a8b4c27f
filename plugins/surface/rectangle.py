"""A flat rectangle."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.rectangle import rectangle
from surfexp.mesh.surface import Surface


@register("surface", "rectangle", defaults_of=rectangle)
def rectangle_surface(
    *,
    n_x: Annotated[int, Field(ge=2, le=4000, description="vertices along x")],
    n_y: Annotated[int, Field(ge=2, le=4000, description="vertices along y")],
    width: Annotated[float, Field(gt=0, description="length along x; default: the root of 2.1")],
    height: Annotated[float, Field(gt=0, description="length along y")],
) -> Surface:
    """Flat rectangle with alternating diagonals, of irrational aspect by default."""
    return rectangle(n_x=n_x, n_y=n_y, width=width, height=height)
