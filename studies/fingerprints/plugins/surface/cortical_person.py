"""Members of the generated population, each seen again under changes."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp_studies.fingerprints.people import cortical_person

register(
    "surface",
    "cortical_person",
    options={
        "number": Field(0, ge=0, le=1000000, description="number of the subject"),
        "change": Field(description="how the person is seen again; half and quarter are shares of the vertices"),
        "strain": Field(ge=0, le=0.3, description="root mean square strain of the deformations"),
        "wavelength": Field(gt=0, le=1000000.0, description="of the deformations, in the template's unit"),
        "seed": Field(ge=0, description="seed of the population; 2 is that of the sulci study"),
    },
)(cortical_person)
