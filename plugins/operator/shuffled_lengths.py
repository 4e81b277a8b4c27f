"""The geometry of a surface taken away: edge lengths shuffled."""

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.operators.shuffled_lengths import SWEEPS, shuffled_lengths
from surfexp.operators.surface_operator import SurfaceOperator


class ShuffledLengths(Options):
    """How lengths change places."""

    seed: int = Field(0, ge=0, description="seed of the exchanges")
    sweeps: int = Field(SWEEPS, ge=1, le=10000, description="exchanges that are tried, over the number of edges")


METRICS = {
    "accepted": Metric("share of tried exchanges that all triangles allowed"),
    "moved": Metric("share of edges with another length than before"),
    "correlation": Metric("correlation of an edge's length with its length before"),
}


@register("operator", "shuffled_lengths", metrics=METRICS)
def shuffled_lengths_operator(options: ShuffledLengths, *, surface: Surface) -> SurfaceOperator:
    """Finite elements on the same triangles with edge lengths exchanged at random, every triangle inequality kept."""
    return shuffled_lengths(surface.mesh, options.seed, options.sweeps)
