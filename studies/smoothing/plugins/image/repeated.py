"""Maps that are measured twice."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp_studies.smoothing.planted_maps import planted_parcels, repeated_map

register(
    "image",
    "planted_parcels",
    options={
        "parcels": Field(ge=2, le=1000, description="number of parcels"),
        "contrast": Field(ge=0, le=1000, description="difference of the two levels in noise levels; 0: noise alone"),
        "correlation": Field(ge=0, description="full width at half maximum of the noise, unit of the surface"),
        "seed": Field(ge=0, description="seed of the parcels and of the noise"),
    },
)(planted_parcels)


register(
    "image",
    "repeated_map",
    options={
        "name": Field("thickness", min_length=1, description="map of the surface"),
        "noise": Field(gt=0, le=100, description="standard deviation of the noise over that of the map"),
        "seed": Field(ge=0, description="seed of the noise"),
    },
    names={"name": "map"},
)(repeated_map)
