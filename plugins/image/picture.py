"""A picture painted on a surface, with noise."""

from dataclasses import replace
from pathlib import Path
from typing import Literal

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.variational.image import Image
from surfexp.variational.images.painting import add_noise, paint
from surfexp.variational.images.pictures import picture, read_picture


class Picture(Options):
    """The picture, its projection on the surface, and the noise."""

    picture: str = Field("cameraman", description="letters, or the name of a picture that scikit-image carries")
    path: Path | None = Field(None, description="a picture file of your own in place of `picture`")
    projection: Literal["cylindrical", "spherical", "planar", "coordinates"] = Field(
        "cylindrical", description="how the picture's plane is laid on the surface"
    )
    front: tuple[float, float, float] = Field((-1.0, 0.0, 0.0), description="direction from which it is seen upright")
    up: tuple[float, float, float] = Field((0.0, 0.0, 1.0), description="the picture's upward direction")
    width: float | None = Field(
        None, gt=0, description="width in the plane of the projection; default: covers the surface"
    )
    noise: float = Field(0.0, ge=0, description="standard deviation of the Gaussian noise, of 0..255")
    seed: int = Field(0, ge=0, description="seed of the noise")


@register("image", "picture")
def picture_image(options: Picture, *, surface: Surface) -> Image:
    """A picture of 0..255 sampled at the vertices, with seeded Gaussian noise; the clean one is kept for comparison."""
    pixels = read_picture(options.path) if options.path else picture(options.picture)
    name = options.path.stem if options.path else options.picture
    painted = paint(
        surface, pixels, options.projection, front=options.front, up=options.up, width=options.width, name=name
    )
    if name == "letters":
        painted = replace(painted, labels={"paper": painted.values > 127.5})
    return add_noise(replace(painted, unit="grey levels"), options.noise, options.seed)
