"""The sphere with nearly equilateral triangles."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.icosphere import icosphere

register(
    "surface",
    "icosphere",
    options={
        "levels": Field(ge=0, le=8, description="subdivisions of the icosahedron"),
        "radius": Field(gt=0, description="radius"),
    },
)(icosphere)
