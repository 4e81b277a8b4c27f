"""A surface made hard to recognise, for tests of invariance."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.studies.populations.disguise import disguise


@register("surface", "disguised", defaults_of=disguise)
def disguised_surface(
    original: Surface,
    *,
    shuffled: Annotated[bool, Field(description="vertices in a random order")],
    rotated: Annotated[bool, Field(description="turned in space at random")],
    scale: Annotated[float, Field(gt=0, le=1000000.0, description="factor of all lengths")],
    bend: Annotated[float, Field(ge=-6, le=6, description="roll the longest axis into an arc of this angle, radians")],
    remeshed: Annotated[bool, Field(description="edges split and contracted, nearly no vertex stays")],
    seed: Annotated[int, Field(ge=0, description="seed of order and rotation")],
) -> Surface:
    """Another surface shuffled, rotated, scaled, bent or meshed anew, with the true origin of its vertices."""
    return disguise(original, shuffled=shuffled, rotated=rotated, scale=scale, bend=bend, remeshed=remeshed, seed=seed)
