"""An ellipsoid."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.ellipsoid import ellipsoid
from surfexp.mesh.surface import Surface


@register("surface", "ellipsoid", defaults_of=ellipsoid)
def ellipsoid_surface(
    *,
    levels: Annotated[int, Field(ge=0, le=8, description="subdivisions of the icosahedron")],
    semiaxes: Annotated[tuple[float, float, float], Field(description="semiaxes along x, y, z")],
) -> Surface:
    """Icosphere stretched to three semiaxes."""
    return ellipsoid(levels=levels, semiaxes=semiaxes)
