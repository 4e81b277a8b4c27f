"""The geometry of a surface taken away: edge lengths shuffled."""

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.operators.shuffled_lengths import shuffled_lengths

METRICS = {
    "accepted": Metric("share of tried exchanges that all triangles allowed"),
    "moved": Metric("share of edges with another length than before"),
    "correlation": Metric("correlation of an edge's length with its length before"),
}

register(
    "operator",
    "shuffled_lengths",
    summary="Finite elements on the same triangles with edge lengths exchanged at random, every triangle inequality kept.",
    options={
        "seed": Field(ge=0, description="seed of the exchanges"),
        "sweeps": Field(ge=1, le=10000, description="exchanges that are tried, over the number of edges"),
    },
    metrics=METRICS,
)(shuffled_lengths)
