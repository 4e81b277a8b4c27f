"""An ellipsoid."""

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.shapes.ellipsoid import ellipsoid
from surfexp.mesh.surface import Surface


class Ellipsoid(Options):
    """Axes and resolution of the ellipsoid."""

    levels: int = Field(4, ge=0, le=8, description="subdivisions of the icosahedron")
    semiaxes: tuple[float, float, float] = Field((1.0, 1.3, 0.8), description="semiaxes along x, y, z")


@register("surface", "ellipsoid")
def ellipsoid_surface(options: Ellipsoid) -> Surface:
    """Icosphere stretched to three semiaxes."""
    return ellipsoid(**dict(options))
