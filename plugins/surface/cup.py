"""The one-handled cup of figure 2.2."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.cup import cup

register(
    "surface",
    "cup",
    options={
        "count": Field(ge=2000, le=400000, description="number of vertices"),
    },
    names={"count": "vertices"},
)(cup)
