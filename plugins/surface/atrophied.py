"""A surface with a planted loss of tissue, section 4.5."""

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.studies.populations.atrophy import with_atrophy


class Atrophied(Options):
    """How much is lost, and where."""

    depth: float = Field(1.0, ge=0, le=100, description="depth of the dent at the tip, unit of length")
    reach: float = Field(0.25, gt=0, le=2, description="reach of the dent, share of the longest axis")


METRICS = {
    "tissue_lost": Metric("planted loss of volume, share"),
}


@register("surface", "atrophied", metrics=METRICS)
def atrophied_surface(options: Atrophied, *, original: Surface) -> Surface:
    """Another surface with a smooth, clearly synthetic dent at the front end of its longest axis."""
    return with_atrophy(original, options.depth, options.reach)
