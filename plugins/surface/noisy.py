"""A surface with noise on its vertices, figure 2.7."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.noise import add_vertex_noise

register(
    "surface",
    "noisy",
    options={
        "sigma": Field(0.1, ge=0, description="standard deviation of the noise in each coordinate, unit of length"),
        "direction": Field(description="noise in space, or along the normals alone"),
        "seed": Field(ge=0, description="seed of the noise"),
    },
    names={"surface": "clean"},
)(add_vertex_noise)
