"""The one-handled cup of figure 2.2."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.cup import cup
from surfexp.mesh.surface import Surface


@register("surface", "cup")
def cup_surface(
    *, vertices: Annotated[int, Field(ge=2000, le=400000, description="number of vertices")] = 25075
) -> Surface:
    """A cup with one handle, closed, genus 1."""
    return cup(vertices)
