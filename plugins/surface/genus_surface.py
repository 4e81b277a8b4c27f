"""A row of joined tori."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.genus_surface import genus_surface

register(
    "surface",
    "genus_surface",
    options={
        "genus": Field(ge=1, le=8, description="number of holes"),
        "count": Field(ge=3000, le=400000, description="number of vertices"),
    },
)(genus_surface)
