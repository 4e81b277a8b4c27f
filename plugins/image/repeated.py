"""Maps that are measured twice."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.studies.smoothing.planted_maps import planted_parcels, repeated_map
from surfexp.variational.image import Image


@register("image", "planted_parcels", defaults_of=planted_parcels)
def planted_parcels_image(
    surface: Surface,
    *,
    parcels: Annotated[int, Field(ge=2, le=1000, description="number of parcels")],
    contrast: Annotated[
        float, Field(ge=0, le=1000, description="difference of the two levels in noise levels; 0: noise alone")
    ],
    correlation: Annotated[
        float, Field(ge=0, description="full width at half maximum of the noise, unit of the surface")
    ],
    seed: Annotated[int, Field(ge=0, description="seed of the parcels and of the noise")],
) -> Image:
    """Parcels of two levels, measured twice with noise of deviation 1."""
    return planted_parcels(surface, parcels=parcels, contrast=contrast, correlation=correlation, seed=seed)


@register("image", "repeated_map", defaults_of=repeated_map)
def repeated_map_image(
    surface: Surface,
    *,
    map: Annotated[str, Field(min_length=1, description="map of the surface")] = "thickness",
    noise: Annotated[float, Field(gt=0, le=100, description="standard deviation of the noise over that of the map")],
    seed: Annotated[int, Field(ge=0, description="seed of the noise")],
) -> Image:
    """A map of the surface in units of its deviation, measured twice with independent noise."""
    return repeated_map(surface, map, noise, seed)
