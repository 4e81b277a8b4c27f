"""Distances between the signatures of a collection, (4.3)."""

from pydantic import Field

from surfexp.contract.member import Member
from surfexp.lab.registry.registry import Options, register
from surfexp.spectrum.signature import Signature
from surfexp.statistics.distance_matrix import DistanceMatrix
from surfexp.statistics.signature_distances import signature_distances


class Signatures(Options):
    """What is compared, and how entries are weighed."""

    part: str = Field("", description="part of the signatures; empty: the signature itself")
    alpha: float = Field(
        1.0,
        ge=0,
        le=4,
        description="entry n is divided by n^alpha, (4.3); 1 finds kinds by shape DNA best; 0: Euclidean",
    )
    length: int | None = Field(None, ge=1, le=100000, description="N, entries that are compared; default: all")


@register("distance_matrix", "signatures")
def signatures_matrix(options: Signatures, *, signatures: dict[Member, Signature]) -> DistanceMatrix:
    """Weighted l2 distance (4.3) between all members of a collection."""
    return signature_distances(signatures, options.part, options.alpha, options.length)
