"""One hemisphere of a synthetic population, for studies whose truth is known."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.populations.synthetic_subject import synthetic_subject

register(
    "surface",
    "synthetic_subject",
    options={
        "subject": Field(0, ge=0, le=1000000, description="number of the subject"),
        "side": Field("left", description="the right side is the mirrored template"),
        "strain": Field(ge=0, le=0.3, description="root mean square strain of the random deformations"),
        "wavelength": Field(gt=0, le=1000000.0, description="of the deformations, in the template's unit"),
        "remeshed": Field(description="vertices of its own"),
        "seed": Field(ge=0, description="seed of the population"),
    },
)(synthetic_subject)
