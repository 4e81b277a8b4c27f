"""Distances between the signatures of a collection, (4.3)."""

from typing import Annotated

from pydantic import Field

from surfexp.contract.member import Member
from surfexp.lab.registry.registry import register
from surfexp.spectrum.signature import Signature
from surfexp.statistics.distance_matrix import DistanceMatrix
from surfexp.statistics.signature_distances import signature_distances


@register("distance_matrix", "signatures", defaults_of=signature_distances)
def signatures_matrix(
    signatures: dict[Member, Signature],
    *,
    part: Annotated[str, Field(description="part of the signatures; empty: the signature itself")],
    alpha: Annotated[
        float,
        Field(
            ge=0,
            le=4,
            description="entry n is divided by n^alpha, (4.3); 1 finds kinds by shape DNA best; 0: Euclidean",
        ),
    ],
    length: Annotated[int | None, Field(ge=1, le=100000, description="N, entries that are compared; default: all")],
) -> DistanceMatrix:
    """Weighted l2 distance (4.3) between all members of a collection."""
    return signature_distances(signatures, part, alpha, length)
