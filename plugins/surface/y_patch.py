"""A branched patch."""

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.shapes.strip import y_patch
from surfexp.mesh.surface import Surface


class YPatch(Options):
    """A flat Y."""

    edge_length: float = Field(0.25, ge=0.02, le=0.5, description="side of the triangles")
    arm: float = Field(6.0, ge=3, le=100, description="length of each arm")
    width: float = Field(2.0, ge=2, le=60, description="width of each arm")
    stem: float = Field(
        1.25, ge=1, le=5, description="first arm over the others; at 1 the first eigenvalue is double at any resolution"
    )


@register("surface", "y_patch")
def y_patch_surface(options: YPatch) -> Surface:
    """A flat patch of three arms at 120 degrees, whose skeleton has three leaves."""
    return y_patch(**dict(options))
