"""The open hand of figure 2.5."""

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.shapes.hand import hand
from surfexp.mesh.surface import Surface


class Hand(Options):
    """The number of vertices."""

    count: int = Field(58875, ge=4000, le=400000, description="number of vertices")


@register("surface", "hand")
def hand_surface(options: Hand) -> Surface:
    """Open hand with five fingers, one boundary loop at the wrist, genus 0."""
    return hand(**dict(options))
