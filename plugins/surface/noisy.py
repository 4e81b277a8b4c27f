"""A surface with noise on its vertices, figure 2.7."""

from typing import Literal

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.noise import add_vertex_noise
from surfexp.mesh.surface import Surface


class Noisy(Options):
    """Size and direction of the noise."""

    sigma: float = Field(0.1, ge=0, description="standard deviation of the noise in each coordinate, unit of length")
    direction: Literal["all", "normal"] = Field("all", description="noise in space, or along the normals alone")
    seed: int = Field(0, ge=0, description="seed of the noise")


@register("surface", "noisy")
def noisy_surface(options: Noisy, *, clean: Surface) -> Surface:
    """Another surface with seeded Gaussian noise on its vertices."""
    return add_vertex_noise(clean, options.sigma, options.seed, options.direction)
