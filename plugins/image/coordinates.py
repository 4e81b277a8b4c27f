"""The coordinates of a surface as an image, (2.41)."""

from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.variational.image import Image


@register("image", "coordinates")
def coordinates_image(
    surface: Surface,
    clean: Surface,
    *,
    noise: Annotated[
        float, Field(gt=0, description="standard deviation of the noise that the vertices carry, unit of length")
    ] = 0.1,
) -> Image:
    """The three coordinate functions of a noisy surface as an image, those of the clean one as its truth (2.41)."""
    vertices, truth = surface.mesh.vertices, clean.mesh.vertices
    if vertices.shape != truth.shape:
        raise ValueError(
            f"the clean surface has {len(truth)} vertices, the noisy one {len(vertices)}; equal are needed"
        )
    return Image(np.array(vertices), "coordinates", surface.unit, clean=np.array(truth), noise=noise)
