"""Surfaces of revolution, among them those on which the published distance is no metric."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.counterexamples import clover, named_revolution

register(
    "surface",
    "revolution",
    options={
        "profile": Annotated[
            Literal["sphere", "dumbbell", "cigar", "pear", "needle_ball", "two_balls"],
            Field("dumbbell", description="curve that is turned about the axis"),
        ],
        "rows": Field(ge=2, le=5000, description="circles of vertices between the poles"),
        "columns": Field(ge=3, le=5000, description="vertices on each circle"),
    },
)(named_revolution)


register(
    "surface",
    "clover",
    options={
        "levels": Field(ge=0, le=8, description="subdivisions of the icosahedron"),
        "lobes": Field(ge=3, le=20, description="equal lobes about the axis"),
        "depth": Field(ge=0, lt=1, description="depth of the notches between lobes, share of the radius"),
        "squeeze": Field(ge=0, lt=0.5, description="share by which the body is shortened in one direction"),
        "angle": Field(ge=-360, le=360, description="direction of the squeeze, degrees"),
    },
)(clover)
