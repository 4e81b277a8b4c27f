"""One hemisphere of a synthetic population, for studies whose truth is known."""

from typing import Literal

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.studies.sulci.population import synthetic_subject


class SyntheticSubject(Options):
    """Which member, and how far it is from the template."""

    subject: int = Field(0, ge=0, le=1000000, description="number of the subject")
    side: Literal["left", "right"] = Field("left", description="the right side is the mirrored template")
    strain: float = Field(0.03, ge=0, le=0.3, description="root mean square strain of the random deformations")
    wavelength: float = Field(60.0, gt=0, le=1e6, description="of the deformations, in the template's unit")
    remeshed: bool = Field(True, description="vertices of its own")
    seed: int = Field(0, ge=0, description="seed of the population")


@register("surface", "synthetic_subject")
def synthetic_subject_surface(options: SyntheticSubject, *, template: Surface) -> Surface:
    """Another surface deformed smoothly at random, meshed anew, shuffled and turned, with the origin of its vertices."""
    return synthetic_subject(template, **dict(options))
