"""An image of two levels with a known boundary."""

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.variational.image import Image
from surfexp.variational.images.initial_curves import angular_distance
from surfexp.variational.images.painting import add_noise
from surfexp.variational.images.two_phase import two_phase


class TwoPhase(Options):
    """The boundary of the two phases, and the noise."""

    direction: tuple[float, float, float] = Field((0.0, 0.0, 1.0), description="axis of the bright cap")
    angle: float = Field(60.0, gt=0, lt=180, description="half opening of the cap, seen from the centre, degrees")
    noise: float = Field(0.0, ge=0, description="standard deviation of the Gaussian noise, of 0..255")
    seed: int = Field(0, ge=0, description="seed of the noise")


METRICS = {
    "boundary_length": Metric("exact length of the boundary", "unit of length"),
}


@register("image", "two_phase", metrics=METRICS)
def two_phase_image(options: TwoPhase, *, surface: Surface) -> Image:
    """A bright cap, 255 on 0, cut by a cone about the centre of area; on a sphere its boundary is a circle."""
    angles = angular_distance(surface.mesh, np.array(options.direction))
    return add_noise(two_phase(surface, angles - np.radians(options.angle)), options.noise, options.seed)
