"""BrainPrint, through LaPy."""

from typing import Annotated

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.brainprint import brainprint
from surfexp.spectrum.signature import Signature

METRICS = {
    "first": Metric("first entry"),
    "last": Metric("last entry"),
}


@register("signature", "brainprint", metrics=METRICS, defaults_of=brainprint)
def brainprint_signature(
    surface: Surface, *, count: Annotated[int, Field(ge=1, le=2000, description="eigenvalues after 0")]
) -> Signature:
    """Shape DNA by LaPy, times the area and over the number of each value, as BrainPrint takes it."""
    return brainprint(surface.mesh, count)
