"""The sphere with nearly equilateral triangles."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface


@register("surface", "icosphere", defaults_of=icosphere)
def icosphere_surface(
    *,
    levels: Annotated[int, Field(ge=0, le=8, description="subdivisions of the icosahedron")],
    radius: Annotated[float, Field(gt=0, description="radius")],
) -> Surface:
    """Sphere of 10 * 4^levels + 2 vertices, all exactly on it."""
    return icosphere(levels=levels, radius=radius)
