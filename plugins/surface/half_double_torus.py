"""The open surface of figure 2.6."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.genus_surface import half_double_torus
from surfexp.mesh.surface import Surface


@register("surface", "half_double_torus", defaults_of=half_double_torus)
def half_double_torus_surface(
    *, count: Annotated[int, Field(ge=1500, le=400000, description="number of vertices")]
) -> Surface:
    """Half of a double torus, cut by a plane: open, three boundary loops (figure 2.6)."""
    return half_double_torus(count)
