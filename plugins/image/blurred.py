"""A blurred image."""

from dataclasses import replace

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.heat_blur import HeatBlur
from surfexp.variational.image import Image
from surfexp.variational.images.painting import add_noise


class Blurred(Options):
    """Width of the blur, and noise."""

    width: float = Field(2.0, gt=0, le=100, description="standard deviation of the blur in edge lengths")
    noise: float = Field(2.0, ge=0, description="standard deviation of the Gaussian noise after the blur, of 0..255")
    seed: int = Field(0, ge=0, description="seed of the noise")


@register("image", "blurred")
def blurred_image(options: Blurred, *, operator: SurfaceOperator, original: Image) -> Image:
    """Another image after one implicit step of heat diffusion, with seeded noise; the sharp one is kept."""
    time = 0.5 * (options.width * operator.edge_length) ** 2
    blur = HeatBlur(operator, original.values, 1.0, time)
    note = f"blurred by heat diffusion, standard deviation {options.width:g} edge lengths"
    sharp = replace(original, values=blur.blur(original.values), clean=original.values, notes=(*original.notes, note))
    return add_noise(sharp, options.noise, options.seed)
