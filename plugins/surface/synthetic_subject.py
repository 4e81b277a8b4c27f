"""One hemisphere of a synthetic population, for studies whose truth is known."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.studies.sulci.population import synthetic_subject


@register("surface", "synthetic_subject", defaults_of=synthetic_subject)
def synthetic_subject_surface(
    template: Surface,
    *,
    subject: Annotated[int, Field(ge=0, le=1000000, description="number of the subject")] = 0,
    side: Annotated[Literal["left", "right"], Field(description="the right side is the mirrored template")] = "left",
    strain: Annotated[float, Field(ge=0, le=0.3, description="root mean square strain of the random deformations")],
    wavelength: Annotated[float, Field(gt=0, le=1000000.0, description="of the deformations, in the template's unit")],
    remeshed: Annotated[bool, Field(description="vertices of its own")],
    seed: Annotated[int, Field(ge=0, description="seed of the population")],
) -> Surface:
    """Another surface deformed smoothly at random, meshed anew, shuffled and turned, with the origin of its vertices."""
    return synthetic_subject(
        template, subject=subject, side=side, strain=strain, wavelength=wavelength, remeshed=remeshed, seed=seed
    )
