"""A branched patch."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.strip import y_patch
from surfexp.mesh.surface import Surface


@register("surface", "y_patch", defaults_of=y_patch)
def y_patch_surface(
    *,
    edge_length: Annotated[float, Field(ge=0.02, le=0.5, description="side of the triangles")],
    arm: Annotated[float, Field(ge=3, le=100, description="length of each arm")],
    width: Annotated[float, Field(ge=2, le=60, description="width of each arm")],
    stem: Annotated[
        float,
        Field(
            ge=1, le=5, description="first arm over the others; at 1 the first eigenvalue is double at any resolution"
        ),
    ],
) -> Surface:
    """A flat patch of three arms at 120 degrees, whose skeleton has three leaves."""
    return y_patch(edge_length=edge_length, arm=arm, width=width, stem=stem)
