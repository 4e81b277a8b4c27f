"""The torus of revolution of figure 2.4."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.surface import Surface


@register("surface", "torus", defaults_of=torus)
def torus_surface(
    *,
    n_u: Annotated[int, Field(ge=3, le=4000, description="vertices around the axis")],
    n_v: Annotated[int, Field(ge=3, le=4000, description="vertices around the tube")],
    major_radius: Annotated[float, Field(gt=0, description="radius of the centre line")],
    minor_radius: Annotated[float, Field(gt=0, description="radius of the tube")],
    jitter: Annotated[float, Field(ge=0, lt=0.25, description="random shift of the parameters, in grid steps")],
    seed: Annotated[int, Field(ge=0, description="seed of the shift")],
) -> Surface:
    """Torus of revolution about z, every vertex exactly on it, genus 1."""
    return torus(n_u=n_u, n_v=n_v, major_radius=major_radius, minor_radius=minor_radius, jitter=jitter, seed=seed)
