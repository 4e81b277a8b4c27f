"""Members of the generated population, each seen again under changes."""

from typing import Literal

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.studies.fingerprints.people import cortical_person


class CorticalPerson(Options):
    """Who, and how the person is seen."""

    number: int = Field(0, ge=0, le=1000000, description="number of the subject")
    change: Literal["original", "resampled", "half", "quarter", "noise"] = Field(
        "original", description="how the person is seen again; half and quarter are shares of the vertices"
    )
    strain: float = Field(0.03, ge=0, le=0.3, description="root mean square strain of the deformations")
    wavelength: float = Field(60.0, gt=0, le=1e6, description="of the deformations, in the template's unit")
    seed: int = Field(2, ge=0, description="seed of the population; 2 is that of the sulci study")


@register("surface", "cortical_person")
def cortical_person_surface(options: CorticalPerson, *, template: Surface) -> Surface:
    """Another surface deformed smoothly at random, a person for each number, as it is or meshed anew."""
    return cortical_person(template, **dict(options))
