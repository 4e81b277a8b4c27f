"""A surface with a planted loss of tissue, section 4.5."""

from typing import Annotated

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.studies.populations.atrophy import with_atrophy

METRICS = {
    "tissue_lost": Metric("planted loss of volume, share"),
}


@register("surface", "atrophied", metrics=METRICS, defaults_of=with_atrophy)
def atrophied_surface(
    original: Surface,
    *,
    depth: Annotated[float, Field(ge=0, le=100, description="depth of the dent at the tip, unit of length")] = 1.0,
    reach: Annotated[float, Field(gt=0, le=2, description="reach of the dent, share of the longest axis")],
) -> Surface:
    """Another surface with a smooth, clearly synthetic dent at the front end of its longest axis."""
    return with_atrophy(original, depth, reach)
