"""A surface with noise on its vertices, figure 2.7."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.noise import add_vertex_noise
from surfexp.mesh.surface import Surface


@register("surface", "noisy", defaults_of=add_vertex_noise)
def noisy_surface(
    clean: Surface,
    *,
    sigma: Annotated[
        float, Field(ge=0, description="standard deviation of the noise in each coordinate, unit of length")
    ] = 0.1,
    direction: Annotated[Literal["all", "normal"], Field(description="noise in space, or along the normals alone")],
    seed: Annotated[int, Field(ge=0, description="seed of the noise")],
) -> Surface:
    """Another surface with seeded Gaussian noise on its vertices."""
    return add_vertex_noise(clean, sigma, seed, direction)
