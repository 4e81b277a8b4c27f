"""A row of joined tori."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.genus_surface import genus_surface
from surfexp.mesh.surface import Surface


@register("surface", "genus_surface", defaults_of=genus_surface)
def genus_surface_surface(
    *,
    genus: Annotated[int, Field(ge=1, le=8, description="number of holes")],
    count: Annotated[int, Field(ge=3000, le=400000, description="number of vertices")],
) -> Surface:
    """Closed surface of a given genus: a row of joined tori."""
    return genus_surface(genus=genus, count=count)
