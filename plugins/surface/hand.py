"""The open hand of figure 2.5."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.hand import hand

register(
    "surface",
    "hand",
    options={
        "count": Field(ge=4000, le=400000, description="number of vertices"),
    },
)(hand)
