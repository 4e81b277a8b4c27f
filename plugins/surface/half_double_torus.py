"""The open surface of figure 2.6."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.genus_surface import half_double_torus

register(
    "surface",
    "half_double_torus",
    options={
        "count": Field(ge=1500, le=400000, description="number of vertices"),
    },
)(half_double_torus)
