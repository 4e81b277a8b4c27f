"""A scalar map of your own."""

from pathlib import Path

from pydantic import Field

from surfexp.io.map_files import read_scalars
from surfexp.mesh.surface import Surface
from surfexp.variational.image import Image
from surfexp.variational.images.painting import add_noise
from surfexp.workflow.registry import Options, register


class File(Options):
    """The file with one value a vertex, its unit, and the noise."""

    path: Path = Field(description=".npy, text, FreeSurfer or GIFTI map with one value a vertex")
    unit: str = Field("", description="unit of the values, for captions")
    noise: float = Field(0.0, ge=0, description="standard deviation of the Gaussian noise to add")
    seed: int = Field(0, ge=0, description="seed of the noise")


@register("image", "file")
def file_image(options: File, *, surface: Surface) -> Image:
    """A scalar map of your own, one value a vertex; refused when its length is not the mesh's."""
    values, count = read_scalars(options.path), len(surface.mesh.vertices)
    if len(values) != count:
        raise ValueError(f"image {options.path} has {len(values)} values, the surface has {count} vertices")
    image = Image(values, options.path.stem, options.unit)
    return add_noise(image, options.noise, options.seed) if options.noise else image  # a map as it came is not clean
