"""A developable strip, for lengths and poses that are known."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.strip import strip

register(
    "surface",
    "strip",
    options={
        "length": Field(gt=0, le=1000000.0, description="length of the flat strip"),
        "width": Field(gt=0, le=1000000.0, description="width of the flat strip"),
        "edge_length": Field(gt=0, le=100000.0, description="side of the triangles"),
        "jag": Field(ge=0, le=0.5, description="deviation of the edge's vertices, in edge lengths"),
        "bend": Field(ge=0, le=1.5, description="largest turning angle of the bent strip, radians"),
        "arch": Field(ge=0, le=3, description="turning of the middle line within the flat strip, radians"),
        "seed": Field(ge=0, description="seed of the jagged edge"),
    },
)(strip)
