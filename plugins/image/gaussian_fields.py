"""Gaussian random fields on a surface."""

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.nulls.fields import gaussian_fields
from surfexp.operators.fem import fem
from surfexp.studies.nulls.planted_length import widths_along
from surfexp.variational.image import Image


class GaussianFields(Options):
    """How smooth they are, and how many."""

    length: float = Field(
        10.0, gt=0, le=1e6, description="full width at half maximum of the correlation, unit of the surface"
    )
    ratio: float = Field(1.0, ge=1, le=100, description="largest length over the least, from back to front")
    count: int = Field(250, ge=1, le=100000, description="number of independent fields, a channel each")
    seed: int = Field(0, ge=0, description="seed of the fields")


@register("image", "gaussian_fields")
def gaussian_fields_image(options: GaussianFields, *, surface: Surface) -> Image:
    """Independent Gaussian fields of variance 1 at each vertex, with a known correlation length that may vary."""
    width = options.length
    widths = width if options.ratio == 1.0 else widths_along(surface.mesh.vertices, width, options.ratio)
    fields = gaussian_fields(fem(surface.mesh), widths, options.count, options.seed)
    return Image(fields, f"Gaussian fields of {width:g} {surface.unit}", "deviations")
