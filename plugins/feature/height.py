"""Heights and coordinates as features."""

from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.skeleton.feature import Feature


@register("feature", "height")
def height_feature(
    surface: Surface,
    *,
    direction: Annotated[tuple[float, float, float], Field(description="direction of height, of any length but 0")] = (
        0.0,
        0.0,
        1.0,
    ),
    random: Annotated[
        int | None, Field(ge=0, description="seed of a random direction, in place of the one given")
    ] = None,
) -> Feature:
    """Height in a direction, a coordinate for instance (figures 5.2 and 5.3); it depends on the pose."""
    up = np.array(direction)
    if random is not None:
        up = np.random.default_rng(random).normal(size=3)
    size = float(np.linalg.norm(up))
    if not size > 0 or not np.isfinite(size):
        raise ValueError(f"direction {direction} has no length, take for instance (0, 0, 1)")
    x, y, z = up / size
    return Feature(surface.mesh.vertices @ (up / size), f"height along ({x:.2f}, {y:.2f}, {z:.2f})", surface.unit)
