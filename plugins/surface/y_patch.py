"""A branched patch."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.strip import y_patch

register(
    "surface",
    "y_patch",
    options={
        "edge_length": Field(ge=0.02, le=0.5, description="side of the triangles"),
        "arm": Field(ge=3, le=100, description="length of each arm"),
        "width": Field(ge=2, le=60, description="width of each arm"),
        "stem": Field(
            ge=1, le=5, description="first arm over the others; at 1 the first eigenvalue is double at any resolution"
        ),
    },
)(y_patch)
