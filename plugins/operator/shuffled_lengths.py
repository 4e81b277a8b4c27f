"""The geometry of a surface taken away: edge lengths shuffled."""

from typing import Annotated

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.operators.shuffled_lengths import shuffled_lengths
from surfexp.operators.surface_operator import SurfaceOperator

METRICS = {
    "accepted": Metric("share of tried exchanges that all triangles allowed"),
    "moved": Metric("share of edges with another length than before"),
    "correlation": Metric("correlation of an edge's length with its length before"),
}


@register("operator", "shuffled_lengths", metrics=METRICS, defaults_of=shuffled_lengths)
def shuffled_lengths_operator(
    surface: Surface,
    *,
    seed: Annotated[int, Field(ge=0, description="seed of the exchanges")],
    sweeps: Annotated[int, Field(ge=1, le=10000, description="exchanges that are tried, over the number of edges")],
) -> SurfaceOperator:
    """Finite elements on the same triangles with edge lengths exchanged at random, every triangle inequality kept."""
    return shuffled_lengths(surface.mesh, seed, sweeps)
