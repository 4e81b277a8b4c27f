"""Synthetic corpora callosa for figures 5.5 to 5.10."""

from typing import Annotated

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.studies.callosum.callosum import callosum

METRICS = {
    "seed": Metric("seed of the shape"),
    "thinning": Metric("planted thinning of the isthmus, share of its width"),
}


@register("surface", "callosum", metrics=METRICS, defaults_of=callosum)
def callosum_surface(
    *,
    seed: Annotated[int, Field(ge=0, description="which member of the population")],
    thinning: Annotated[float, Field(ge=0, le=0.8, description="share by which the isthmus is thinned")],
    edge_length: Annotated[float, Field(ge=0.05, le=2, description="side of the triangles, mm")],
    pixel: Annotated[float, Field(ge=0.1, le=1.5, description="side of the mask's pixels, mm: the jagged edge")],
    turn: Annotated[float, Field(ge=-90, le=90, description="degrees between the mask's grid and the shape")],
    signal: Annotated[
        float | None,
        Field(
            ge=-100,
            le=100,
            description="height of a bump in a synthetic map, in deviations of its noise; default: no map",
        ),
    ],
) -> Surface:
    """Synthetic corpus callosum, flat, with a known midline and the staircase edge of a manual mask."""
    return callosum(seed=seed, thinning=thinning, edge_length=edge_length, pixel=pixel, turn=turn, signal=signal)
