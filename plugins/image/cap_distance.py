"""A level function whose zero line is a circle on the sphere."""

from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.variational.image import Image
from surfexp.variational.images.initial_curves import angular_distance

METRICS = {
    "boundary_length": Metric("exact length of the boundary", "unit of length"),
}


@register("image", "cap_distance", metrics=METRICS)
def cap_distance_image(
    surface: Surface,
    *,
    direction: Annotated[tuple[float, float, float], Field(description="axis of the cap")] = (0.0, 0.0, 1.0),
    angle: Annotated[float, Field(gt=0, lt=180, description="half opening of the cap, degrees")] = 63.0,
) -> Image:
    """Angle from the border of a cap, positive inside: the signed distance on the unit sphere, for flows of curves."""
    angles = angular_distance(surface.mesh, np.array(direction))
    return Image(np.radians(angle) - angles, "distance from a circle", "rad")
