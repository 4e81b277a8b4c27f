"""The one-handled cup of figure 2.2."""

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.shapes.cup import cup
from surfexp.mesh.surface import Surface


class Cup(Options):
    """The number of vertices."""

    vertices: int = Field(25075, ge=2000, le=400000, description="number of vertices")


@register("surface", "cup")
def cup_surface(options: Cup) -> Surface:
    """A cup with one handle, closed, genus 1."""
    return cup(options.vertices)
