"""Maps that are measured twice."""

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.studies.smoothing.planted_maps import planted_parcels, repeated_map
from surfexp.variational.image import Image


class PlantedParcels(Options):
    """The parcels and the noise."""

    parcels: int = Field(12, ge=2, le=1000, description="number of parcels")
    contrast: float = Field(
        1.0, ge=0, le=1000, description="difference of the two levels in noise levels; 0: noise alone"
    )
    correlation: float = Field(0.0, ge=0, description="full width at half maximum of the noise, unit of the surface")
    seed: int = Field(0, ge=0, description="seed of the parcels and of the noise")


@register("image", "planted_parcels")
def planted_parcels_image(options: PlantedParcels, *, surface: Surface) -> Image:
    """Parcels of two levels, measured twice with noise of deviation 1."""
    return planted_parcels(surface, **dict(options))


class RepeatedMap(Options):
    """Which map, and how much noise."""

    map: str = Field("thickness", min_length=1, description="map of the surface")
    noise: float = Field(0.5, gt=0, le=100, description="standard deviation of the noise over that of the map")
    seed: int = Field(0, ge=0, description="seed of the noise")


@register("image", "repeated_map")
def repeated_map_image(options: RepeatedMap, *, surface: Surface) -> Image:
    """A map of the surface in units of its deviation, measured twice with independent noise."""
    return repeated_map(surface, options.map, options.noise, options.seed)
