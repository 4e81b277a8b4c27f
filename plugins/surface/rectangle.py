"""A flat rectangle."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.rectangle import rectangle

register(
    "surface",
    "rectangle",
    options={
        "n_x": Field(ge=2, le=4000, description="vertices along x"),
        "n_y": Field(ge=2, le=4000, description="vertices along y"),
        "width": Field(gt=0, description="length along x; default: the root of 2.1"),
        "height": Field(gt=0, description="length along y"),
    },
)(rectangle)
