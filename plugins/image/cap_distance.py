"""A level function whose zero line is a circle on the sphere."""

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.variational.image import Image
from surfexp.variational.images.initial_curves import angular_distance


class CapDistance(Options):
    """The middle and the rim of the cap."""

    direction: tuple[float, float, float] = Field((0.0, 0.0, 1.0), description="axis of the cap")
    angle: float = Field(63.0, gt=0, lt=180, description="half opening of the cap, degrees")


METRICS = {
    "boundary_length": Metric("exact length of the boundary", "unit of length"),
}


@register("image", "cap_distance", metrics=METRICS)
def cap_distance_image(options: CapDistance, *, surface: Surface) -> Image:
    """Angle from the border of a cap, positive inside: the signed distance on the unit sphere, for flows of curves."""
    angles = angular_distance(surface.mesh, np.array(options.direction))
    return Image(np.radians(options.angle) - angles, "distance from a circle", "rad")
