"""Members of the generated population, each seen again under changes."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.studies.fingerprints.people import cortical_person


@register("surface", "cortical_person", defaults_of=cortical_person)
def cortical_person_surface(
    template: Surface,
    *,
    number: Annotated[int, Field(ge=0, le=1000000, description="number of the subject")] = 0,
    change: Annotated[
        Literal["original", "resampled", "half", "quarter", "noise"],
        Field(description="how the person is seen again; half and quarter are shares of the vertices"),
    ],
    strain: Annotated[float, Field(ge=0, le=0.3, description="root mean square strain of the deformations")],
    wavelength: Annotated[float, Field(gt=0, le=1000000.0, description="of the deformations, in the template's unit")],
    seed: Annotated[int, Field(ge=0, description="seed of the population; 2 is that of the sulci study")],
) -> Surface:
    """Another surface deformed smoothly at random, a person for each number, as it is or meshed anew."""
    return cortical_person(template, number=number, change=change, strain=strain, wavelength=wavelength, seed=seed)
