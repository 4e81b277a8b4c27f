"""Who is recognised by distances that align eigenfunctions."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.contract.member import Member
from surfexp.contract.metric import Metric
from surfexp.embedding.distance_methods import Pairing
from surfexp.embedding.spectral_embedding import spectral_embedding
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.statistics.statistic import Statistic
from surfexp.studies.fingerprints.pairwise_identification import pairwise_identification

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


@register("statistic", "pairwise_identification", metrics=METRICS, defaults_of=Pairing)
def pairwise_identification_statistic(
    surfaces: dict[Member, Surface],
    systems: dict[Member, EigenSystem],
    *,
    method: Annotated[
        Literal["mean_hausdorff", "block_orthogonal"],
        Field(description="exact signs, or orthogonal blocks of nearly equal eigenvalues"),
    ],
    n: Annotated[int, Field(ge=1, le=200, description="number of eigenfunctions")] = 4,
    limit: Annotated[int, Field(ge=2, le=1000000, description="most evaluations of a search for signs")],
    gap: Annotated[
        float, Field(ge=0, lt=1, description="eigenvalues nearer than this, relatively, belong to one block")
    ],
    samples: Annotated[int, Field(ge=10, le=100000, description="points of each surface in searches")],
    seed: Annotated[int, Field(ge=0, description="seed of samples and bases")],
) -> Statistic:
    """Rank-one identification by the spectral distance, least over signs or over blocks.

    Of a member the class is the change, one of them "original", the group the donor, the level the person's number.
    """
    chosen = {"method": method, "n": n, "limit": limit, "gap": gap, "samples": samples, "seed": seed}
    number = chosen.pop("n")
    embeddings = {
        member: spectral_embedding(systems[member], surface.mesh.vertex_areas, number)
        for member, surface in surfaces.items()
    }
    return pairwise_identification(embeddings, Pairing(**chosen))
