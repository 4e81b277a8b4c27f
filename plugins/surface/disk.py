"""A flat disk."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.disk import disk

register(
    "surface",
    "disk",
    options={
        "rings": Field(ge=1, le=1000, description="rings of vertices"),
        "radius": Field(gt=0, description="radius"),
    },
)(disk)
