"""The open hand of figure 2.5."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.hand import hand
from surfexp.mesh.surface import Surface


@register("surface", "hand", defaults_of=hand)
def hand_surface(*, count: Annotated[int, Field(ge=4000, le=400000, description="number of vertices")]) -> Surface:
    """Open hand with five fingers, one boundary loop at the wrist, genus 0."""
    return hand(count=count)
