"""Flat tori, whose spectra are known exactly."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.operators.elements_periodic import periodic_surface

register(
    "surface",
    "flat_torus",
    options={
        "n": Field(ge=3, le=2000, description="vertices along each period"),
        "lattice": Field(description="lattice of unit periods"),
    },
)(periodic_surface)
