"""Flat tori, whose spectra are known exactly."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.operators.elements_periodic import periodic_surface


@register("surface", "flat_torus", defaults_of=periodic_surface)
def flat_torus_surface(
    *,
    n: Annotated[int, Field(ge=3, le=2000, description="vertices along each period")],
    lattice: Annotated[Literal["square", "hexagonal"], Field(description="lattice of unit periods")],
) -> Surface:
    """Plane modulo a lattice, for operator=periodic; drawn in space as a torus of revolution."""
    return periodic_surface(n=n, lattice=lattice)
