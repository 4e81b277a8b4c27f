"""A flat disk."""

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.shapes.disk import disk
from surfexp.mesh.surface import Surface


class Disk(Options):
    """Size and resolution of the disk."""

    rings: int = Field(30, ge=1, le=1000, description="rings of vertices")
    radius: float = Field(1.0, gt=0, description="radius")


@register("surface", "disk")
def disk_surface(options: Disk) -> Surface:
    """Flat disk of 1 + 3 rings (rings + 1) vertices, its rim on the circle."""
    return disk(**dict(options))
