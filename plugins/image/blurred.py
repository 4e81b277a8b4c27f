"""A blurred image."""

from dataclasses import replace
from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.heat_blur import HeatBlur
from surfexp.variational.image import Image
from surfexp.variational.images.painting import add_noise


@register("image", "blurred", defaults_of=add_noise)
def blurred_image(
    operator: SurfaceOperator,
    original: Image,
    *,
    width: Annotated[float, Field(gt=0, le=100, description="standard deviation of the blur in edge lengths")] = 2.0,
    noise: Annotated[
        float, Field(ge=0, description="standard deviation of the Gaussian noise after the blur, of 0..255")
    ] = 2.0,
    seed: Annotated[int, Field(ge=0, description="seed of the noise")],
) -> Image:
    """Another image after one implicit step of heat diffusion, with seeded noise; the sharp one is kept."""
    time = 0.5 * (width * operator.edge_length) ** 2
    blur = HeatBlur(operator, original.values, 1.0, time)
    note = f"blurred by heat diffusion, standard deviation {width:g} edge lengths"
    sharp = replace(original, values=blur.blur(original.values), clean=original.values, notes=(*original.notes, note))
    return add_noise(sharp, noise, seed)
