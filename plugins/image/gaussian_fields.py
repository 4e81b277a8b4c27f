"""Gaussian random fields on a surface."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.nulls.fields import gaussian_fields
from surfexp.operators.fem import fem
from surfexp.studies.nulls.planted_length import widths_along
from surfexp.variational.image import Image


@register("image", "gaussian_fields", defaults_of=gaussian_fields)
def gaussian_fields_image(
    surface: Surface,
    *,
    length: Annotated[
        float,
        Field(gt=0, le=1000000.0, description="full width at half maximum of the correlation, unit of the surface"),
    ] = 10.0,
    ratio: Annotated[float, Field(ge=1, le=100, description="largest length over the least, from back to front")] = 1.0,
    count: Annotated[int, Field(ge=1, le=100000, description="number of independent fields, a channel each")] = 250,
    seed: Annotated[int, Field(ge=0, description="seed of the fields")],
) -> Image:
    """Independent Gaussian fields of variance 1 at each vertex, with a known correlation length that may vary."""
    width = length
    widths = width if ratio == 1.0 else widths_along(surface.mesh.vertices, width, ratio)
    fields = gaussian_fields(fem(surface.mesh), widths, count, seed)
    return Image(fields, f"Gaussian fields of {width:g} {surface.unit}", "deviations")
