"""A surface made hard to recognise, for tests of invariance."""

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.studies.populations.disguise import disguise


class Disguised(Options):
    """What is changed."""

    shuffled: bool = Field(True, description="vertices in a random order")
    rotated: bool = Field(True, description="turned in space at random")
    scale: float = Field(1.0, gt=0, le=1e6, description="factor of all lengths")
    bend: float = Field(0.0, ge=-6, le=6, description="roll the longest axis into an arc of this angle, radians")
    remeshed: bool = Field(False, description="edges split and contracted, nearly no vertex stays")
    seed: int = Field(0, ge=0, description="seed of order and rotation")


@register("surface", "disguised")
def disguised_surface(options: Disguised, *, original: Surface) -> Surface:
    """Another surface shuffled, rotated, scaled, bent or meshed anew, with the true origin of its vertices."""
    return disguise(original, **dict(options))
