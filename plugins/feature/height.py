"""Heights and coordinates as features."""

import numpy as np
from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.skeleton.feature import Feature


class Height(Options):
    """Which way is up."""

    direction: tuple[float, float, float] = Field(
        (0.0, 0.0, 1.0), description="direction of height, of any length but 0"
    )
    random: int | None = Field(None, ge=0, description="seed of a random direction, in place of the one given")


@register("feature", "height")
def height_feature(options: Height, *, surface: Surface) -> Feature:
    """Height in a direction, a coordinate for instance (figures 5.2 and 5.3); it depends on the pose."""
    direction = np.array(options.direction)
    if options.random is not None:
        direction = np.random.default_rng(options.random).normal(size=3)
    size = float(np.linalg.norm(direction))
    if not size > 0 or not np.isfinite(size):
        raise ValueError(f"direction {options.direction} has no length, take for instance (0, 0, 1)")
    x, y, z = direction / size
    return Feature(
        surface.mesh.vertices @ (direction / size), f"height along ({x:.2f}, {y:.2f}, {z:.2f})", surface.unit
    )
