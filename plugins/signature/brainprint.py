"""BrainPrint, through LaPy."""

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.brainprint import brainprint
from surfexp.spectrum.signature import Signature


class BrainPrint(Options):
    """How many values."""

    count: int = Field(50, ge=1, le=2000, description="eigenvalues after 0")


METRICS = {
    "first": Metric("first entry"),
    "last": Metric("last entry"),
}


@register("signature", "brainprint", metrics=METRICS)
def brainprint_signature(options: BrainPrint, *, surface: Surface) -> Signature:
    """Shape DNA by LaPy, times the area and over the number of each value, as BrainPrint takes it."""
    return brainprint(surface.mesh, options.count)
