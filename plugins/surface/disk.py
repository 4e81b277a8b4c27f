"""A flat disk."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.disk import disk
from surfexp.mesh.surface import Surface


@register("surface", "disk", defaults_of=disk)
def disk_surface(
    *,
    rings: Annotated[int, Field(ge=1, le=1000, description="rings of vertices")],
    radius: Annotated[float, Field(gt=0, description="radius")],
) -> Surface:
    """Flat disk of 1 + 3 rings (rings + 1) vertices, its rim on the circle."""
    return disk(rings=rings, radius=radius)
