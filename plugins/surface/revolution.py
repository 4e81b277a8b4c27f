"""Surfaces of revolution, among them those on which the published distance is no metric."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.studies.distances.counterexamples import clover, named_revolution


@register("surface", "revolution", defaults_of=named_revolution)
def revolution_surface(
    *,
    profile: Annotated[
        Literal["sphere", "dumbbell", "cigar", "pear", "needle_ball", "two_balls"],
        Field(description="curve that is turned about the axis"),
    ] = "dumbbell",
    rows: Annotated[int, Field(ge=2, le=5000, description="circles of vertices between the poles")],
    columns: Annotated[int, Field(ge=3, le=5000, description="vertices on each circle")],
) -> Surface:
    """Closed surface of revolution from a named profile; needle_ball and two_balls break the triangle inequality."""
    return named_revolution(profile=profile, rows=rows, columns=columns)


@register("surface", "clover", defaults_of=clover)
def clover_surface(
    *,
    levels: Annotated[int, Field(ge=0, le=8, description="subdivisions of the icosahedron")],
    lobes: Annotated[int, Field(ge=3, le=20, description="equal lobes about the axis")],
    depth: Annotated[float, Field(ge=0, lt=1, description="depth of the notches between lobes, share of the radius")],
    squeeze: Annotated[float, Field(ge=0, lt=0.5, description="share by which the body is shortened in one direction")],
    angle: Annotated[float, Field(ge=-360, le=360, description="direction of the squeeze, degrees")],
) -> Surface:
    """Flat body with equal lobes, whose double eigenvalue splits when it is squeezed."""
    return clover(levels=levels, lobes=lobes, depth=depth, squeeze=squeeze, angle=angle)
