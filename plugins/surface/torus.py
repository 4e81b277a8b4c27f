"""The torus of revolution of figure 2.4."""

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.surface import Surface


class Torus(Options):
    """Size, resolution and irregularity of the torus."""

    n_u: int = Field(405, ge=3, le=4000, description="vertices around the axis")
    n_v: int = Field(162, ge=3, le=4000, description="vertices around the tube")
    major_radius: float = Field(1.0, gt=0, description="radius of the centre line")
    minor_radius: float = Field(0.4, gt=0, description="radius of the tube")
    jitter: float = Field(0.0, ge=0, lt=0.25, description="random shift of the parameters, in grid steps")
    seed: int = Field(0, ge=0, description="seed of the shift")


@register("surface", "torus")
def torus_surface(options: Torus) -> Surface:
    """Torus of revolution about z, every vertex exactly on it, genus 1."""
    return torus(**dict(options))
