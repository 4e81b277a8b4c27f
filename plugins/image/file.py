"""A scalar map of your own."""

from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.io.map_files import read_scalars
from surfexp.io.quantity_of_file import quantity_named
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.variational.image import Image
from surfexp.variational.images.painting import add_noise


@register("image", "file", defaults_of=add_noise)
def file_image(
    surface: Surface,
    *,
    path: Annotated[Path, Field(description=".npy, text, FreeSurfer or GIFTI map with one value a vertex")],
    unit: Annotated[str, Field(description="unit of the values, for captions")] = "",
    noise: Annotated[float, Field(ge=0, description="standard deviation of the Gaussian noise to add")] = 0.0,
    seed: Annotated[int, Field(ge=0, description="seed of the noise")],
) -> Image:
    """A scalar map of your own, one value a vertex of the file's surface; refused when it does not fit."""
    values, part = read_scalars(path), surface.part
    if part is not None and len(values) == part.whole_count:
        values = values[part.vertices]
    if len(values) != len(surface.mesh.vertices):
        raise ValueError(
            f"image {path} has {len(values)} values, the surface has {len(surface.mesh.vertices)} vertices"
        )
    if unknown := int(np.isnan(values).sum()):
        raise ValueError(
            f"image {path} is NaN at {unknown} of {len(values)} vertices: cut them away by surface.finite={path}"
        )
    image = Image(values, quantity_named(path.name), unit)
    return add_noise(image, noise, seed) if noise else image  # a map as it came is not clean
