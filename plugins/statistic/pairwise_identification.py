"""Who is recognised by distances that align eigenfunctions."""

from typing import Literal

from pydantic import Field

from surfexp.contract.member import Member
from surfexp.contract.metric import Metric
from surfexp.embedding.distance_methods import Pairing
from surfexp.embedding.spectral_embedding import spectral_embedding
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.statistics.statistic import Statistic
from surfexp.studies.fingerprints.pairwise_identification import pairwise_identification


class PairwiseIdentification(Options):
    """Which distance; the defaults are those of distance_matrix/pairs."""

    method: Literal["mean_hausdorff", "block_orthogonal"] = Field(
        "mean_hausdorff", description="exact signs, or orthogonal blocks of nearly equal eigenvalues"
    )
    n: int = Field(4, ge=1, le=200, description="number of eigenfunctions")
    limit: int = Field(2000, ge=2, le=1000000, description="most evaluations of a search for signs")
    gap: float = Field(0.03, ge=0, lt=1, description="eigenvalues nearer than this, relatively, belong to one block")
    samples: int = Field(1500, ge=10, le=100000, description="points of each surface in searches")
    seed: int = Field(0, ge=0, description="seed of samples and bases")


METRICS = {
    "people": Metric("people"),
    "pairs": Metric("pairs of surfaces"),
    "proved": Metric("share of distances that are proved least", better="higher"),
    "rank_one": Metric("share recognised over all changes", better="higher"),
    "rank_one_low": Metric("lower end of its 95 % interval"),
    "rank_one_high": Metric("upper end of its 95 % interval"),
    "rank_one {change}": Metric("share recognised after a change", better="higher"),
    "rank_one_low {change}": Metric("lower end of its 95 % interval"),
    "rank_one_high {change}": Metric("upper end of its 95 % interval"),
}


@register("statistic", "pairwise_identification", metrics=METRICS)
def pairwise_identification_statistic(
    options: PairwiseIdentification, *, surfaces: dict[Member, Surface], systems: dict[Member, EigenSystem]
) -> Statistic:
    """Rank-one identification by the spectral distance, least over signs or over blocks.

    Of a member the class is the change, one of them "original", the group the donor, the level the person's number.
    """
    chosen = dict(options)
    n = chosen.pop("n")
    embeddings = {
        member: spectral_embedding(systems[member], surface.mesh.vertex_areas, n)
        for member, surface in surfaces.items()
    }
    return pairwise_identification(embeddings, Pairing(**chosen))
