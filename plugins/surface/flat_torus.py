"""Flat tori, whose spectra are known exactly."""

from typing import Literal

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.operators.elements_periodic import periodic_surface


class FlatTorus(Options):
    """The grid and the lattice."""

    n: int = Field(40, ge=3, le=2000, description="vertices along each period")
    lattice: Literal["square", "hexagonal"] = Field("square", description="lattice of unit periods")


@register("surface", "flat_torus")
def flat_torus_surface(options: FlatTorus) -> Surface:
    """Plane modulo a lattice, for operator=periodic; drawn in space as a torus of revolution."""
    return periodic_surface(**dict(options))
