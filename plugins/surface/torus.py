"""The torus of revolution of figure 2.4."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.torus import torus

register(
    "surface",
    "torus",
    options={
        "n_u": Field(ge=3, le=4000, description="vertices around the axis"),
        "n_v": Field(ge=3, le=4000, description="vertices around the tube"),
        "major_radius": Field(gt=0, description="radius of the centre line"),
        "minor_radius": Field(gt=0, description="radius of the tube"),
        "jitter": Field(ge=0, lt=0.25, description="random shift of the parameters, in grid steps"),
        "seed": Field(ge=0, description="seed of the shift"),
    },
)(torus)
