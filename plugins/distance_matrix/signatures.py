"""Distances between the signatures of a collection, (4.3)."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.statistics.signature_distances import signature_distances

register(
    "distance_matrix",
    "signatures",
    options={
        "part": Field(description="part of the signatures; empty: the signature itself"),
        "alpha": Field(
            ge=0,
            le=4,
            description="entry n is divided by n^alpha, (4.3); 1 finds kinds by shape DNA best; 0: Euclidean",
        ),
        "length": Field(ge=1, le=100000, description="N, entries that are compared; default: all"),
    },
)(signature_distances)
