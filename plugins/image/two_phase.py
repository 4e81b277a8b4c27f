"""An image of two levels with a known boundary."""

from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.variational.image import Image
from surfexp.variational.images.initial_curves import angular_distance
from surfexp.variational.images.painting import add_noise
from surfexp.variational.images.two_phase import two_phase

METRICS = {
    "boundary_length": Metric("exact length of the boundary", "unit of length"),
}


@register("image", "two_phase", metrics=METRICS, defaults_of=add_noise)
def two_phase_image(
    surface: Surface,
    *,
    direction: Annotated[tuple[float, float, float], Field(description="axis of the bright cap")] = (0.0, 0.0, 1.0),
    angle: Annotated[
        float, Field(gt=0, lt=180, description="half opening of the cap, seen from the centre, degrees")
    ] = 60.0,
    noise: Annotated[float, Field(ge=0, description="standard deviation of the Gaussian noise, of 0..255")] = 0.0,
    seed: Annotated[int, Field(ge=0, description="seed of the noise")],
) -> Image:
    """A bright cap, 255 on 0, cut by a cone about the centre of area; on a sphere its boundary is a circle."""
    angles = angular_distance(surface.mesh, np.array(direction))
    return add_noise(two_phase(surface, angles - np.radians(angle)), noise, seed)
