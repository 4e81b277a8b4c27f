"""The open surface of figure 2.6."""

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.shapes.genus_surface import half_double_torus
from surfexp.mesh.surface import Surface


class HalfDoubleTorus(Options):
    """The number of vertices."""

    count: int = Field(31247, ge=1500, le=400000, description="number of vertices")


@register("surface", "half_double_torus")
def half_double_torus_surface(options: HalfDoubleTorus) -> Surface:
    """Half of a double torus, cut by a plane: open, three boundary loops (figure 2.6)."""
    return half_double_torus(options.count)
