"""A scalar map of your own."""

from pathlib import Path

import numpy as np
from pydantic import Field

from surfexp.io.map_files import read_scalars
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.variational.image import Image
from surfexp.variational.images.painting import add_noise


class File(Options):
    """The file with one value a vertex, its unit, and the noise."""

    path: Path = Field(description=".npy, text, FreeSurfer or GIFTI map with one value a vertex")
    unit: str = Field("", description="unit of the values, for captions")
    noise: float = Field(0.0, ge=0, description="standard deviation of the Gaussian noise to add")
    seed: int = Field(0, ge=0, description="seed of the noise")


@register("image", "file")
def file_image(options: File, *, surface: Surface) -> Image:
    """A scalar map of your own, one value a vertex of the file's surface; refused when it does not fit."""
    values, part = read_scalars(options.path), surface.part
    if part is not None and len(values) == part.whole_count:
        values = values[part.vertices]
    if len(values) != len(surface.mesh.vertices):
        raise ValueError(
            f"image {options.path} has {len(values)} values, the surface has {len(surface.mesh.vertices)} vertices"
        )
    if unknown := int(np.isnan(values).sum()):
        raise ValueError(
            f"image {options.path} is NaN at {unknown} of {len(values)} vertices: cut them away by surface.finite={options.path}"
        )
    image = Image(values, options.path.stem, options.unit)
    return add_noise(image, options.noise, options.seed) if options.noise else image  # a map as it came is not clean
