"""An ellipsoid."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.ellipsoid import ellipsoid

register(
    "surface",
    "ellipsoid",
    options={
        "levels": Field(ge=0, le=8, description="subdivisions of the icosahedron"),
        "semiaxes": Field(description="semiaxes along x, y, z"),
    },
)(ellipsoid)
