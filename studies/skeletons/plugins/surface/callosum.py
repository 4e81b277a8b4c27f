"""Synthetic corpora callosa for figures 5.5 to 5.10."""

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp_studies.skeletons.callosum import callosum

METRICS = {
    "seed": Metric("seed of the shape"),
    "thinning": Metric("planted thinning of the isthmus, share of its width"),
}


register(
    "surface",
    "callosum",
    metrics=METRICS,
    options={
        "seed": Field(ge=0, description="which member of the population"),
        "thinning": Field(ge=0, le=0.8, description="share by which the isthmus is thinned"),
        "edge_length": Field(ge=0.05, le=2, description="side of the triangles, mm"),
        "pixel": Field(ge=0.1, le=1.5, description="side of the mask's pixels, mm: the jagged edge"),
        "turn": Field(ge=-90, le=90, description="degrees between the mask's grid and the shape"),
        "signal": Field(
            ge=-100,
            le=100,
            description="height of a bump in a synthetic map, in deviations of its noise; default: no map",
        ),
    },
)(callosum)
