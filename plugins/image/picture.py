"""A picture painted on a surface, with noise."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.variational.image import Image
from surfexp.variational.images import pictures
from surfexp.variational.images.painting import add_noise, paint


@register("image", "picture", defaults_of=(paint, add_noise))
def picture_image(
    surface: Surface,
    *,
    picture: Annotated[
        str, Field(description="letters, or the name of a picture that scikit-image carries")
    ] = "cameraman",
    path: Annotated[Path | None, Field(description="a picture file of your own in place of `picture`")] = None,
    projection: Annotated[
        Literal["cylindrical", "spherical", "planar", "coordinates"],
        Field(description="how the picture's plane is laid on the surface"),
    ],
    front: Annotated[tuple[float, float, float], Field(description="direction from which it is seen upright")],
    up: Annotated[tuple[float, float, float], Field(description="the picture's upward direction")],
    width: Annotated[
        float | None, Field(gt=0, description="width in the plane of the projection; default: covers the surface")
    ],
    noise: Annotated[float, Field(ge=0, description="standard deviation of the Gaussian noise, of 0..255")] = 0.0,
    seed: Annotated[int, Field(ge=0, description="seed of the noise")],
) -> Image:
    """A picture of 0..255 sampled at the vertices, with seeded Gaussian noise; the clean one is kept for comparison."""
    pixels = pictures.read_picture(path) if path else pictures.picture(picture)
    name = path.stem if path else picture
    painted = paint(surface, pixels, projection, front=front, up=up, width=width, name=name)
    if name == "letters":
        painted = replace(painted, labels={"paper": painted.values > 127.5})
    return add_noise(replace(painted, unit="grey levels"), noise, seed)
