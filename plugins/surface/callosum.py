"""Synthetic corpora callosa for figures 5.5 to 5.10."""

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.studies.callosum.callosum import callosum


class Callosum(Options):
    """One random corpus callosum."""

    seed: int = Field(0, ge=0, description="which member of the population")
    thinning: float = Field(0.0, ge=0, le=0.8, description="share by which the isthmus is thinned")
    edge_length: float = Field(0.6, ge=0.05, le=2, description="side of the triangles, mm")
    pixel: float = Field(0.7, ge=0.1, le=1.5, description="side of the mask's pixels, mm: the jagged edge")
    turn: float = Field(0.0, ge=-90, le=90, description="degrees between the mask's grid and the shape")
    signal: float | None = Field(
        None,
        ge=-100,
        le=100,
        description="height of a bump in a synthetic map, in deviations of its noise; default: no map",
    )


METRICS = {
    "seed": Metric("seed of the shape"),
    "thinning": Metric("planted thinning of the isthmus, share of its width"),
}


@register("surface", "callosum", metrics=METRICS)
def callosum_surface(options: Callosum) -> Surface:
    """Synthetic corpus callosum, flat, with a known midline and the staircase edge of a manual mask."""
    return callosum(**dict(options))
