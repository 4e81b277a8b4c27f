"""The cube of figure 2.7."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.cube import cube
from surfexp.mesh.surface import Surface


@register("surface", "cube", defaults_of=cube)
def cube_surface(
    *,
    cells: Annotated[int, Field(ge=1, le=400, description="squares along a side")],
    side: Annotated[float, Field(gt=0, description="side length")],
    rotation: Annotated[tuple[float, float, float], Field(description="degrees about x, then y, then z")],
) -> Surface:
    """Cube of 6 cells^2 + 2 vertices, turned by any angles."""
    return cube(cells=cells, side=side, rotation=rotation)
