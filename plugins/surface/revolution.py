"""Surfaces of revolution, among them those on which the published distance is no metric."""

from typing import Literal

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.studies.distances.counterexamples import clover, named_revolution


class Revolution(Options):
    """The profile and its mesh."""

    profile: Literal["sphere", "dumbbell", "cigar", "pear", "needle_ball", "two_balls"] = Field(
        "dumbbell", description="curve that is turned about the axis"
    )
    rows: int = Field(120, ge=2, le=5000, description="circles of vertices between the poles")
    columns: int = Field(32, ge=3, le=5000, description="vertices on each circle")


class Clover(Options):
    """Lobes and squeeze."""

    levels: int = Field(4, ge=0, le=8, description="subdivisions of the icosahedron")
    lobes: int = Field(3, ge=3, le=20, description="equal lobes about the axis")
    depth: float = Field(0.35, ge=0, lt=1, description="depth of the notches between lobes, share of the radius")
    squeeze: float = Field(0.0, ge=0, lt=0.5, description="share by which the body is shortened in one direction")
    angle: float = Field(0.0, ge=-360, le=360, description="direction of the squeeze, degrees")


@register("surface", "revolution")
def revolution_surface(options: Revolution) -> Surface:
    """Closed surface of revolution from a named profile; needle_ball and two_balls break the triangle inequality."""
    return named_revolution(**dict(options))


@register("surface", "clover")
def clover_surface(options: Clover) -> Surface:
    """Flat body with equal lobes, whose double eigenvalue splits when it is squeezed."""
    return clover(**dict(options))
