"""Spectral distances between all members of a collection of surfaces."""

from math import comb
from typing import Annotated, Literal

from pydantic import Field

from surfexp.contract.member import Member
from surfexp.contract.metric import Metric
from surfexp.embedding.distance_methods import (
    Pairing,
    gap_metrics,
    pairwise_distances,
    triangle_metrics,
    unproved_pairs,
)
from surfexp.embedding.spectral_embedding import spectral_embedding
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.statistics.distance_matrix import DistanceMatrix

METRICS = {
    "triangle_ratio": Metric("worst d(a, c) over d(a, b) + d(b, c)", better="lower"),
    "triangles_broken": Metric("share of triples that break the triangle inequality", better="lower"),
    "pairs": Metric("number of pairs"),
    "triples": Metric("number of triples"),
    "largest_distance": Metric("largest distance of a pair"),
    "proved": Metric("share of pairs proved least", better="higher"),
    "mean gap": Metric("mean of distance above its lower bound, relative", better="lower"),
    "largest gap": Metric("largest distance above its lower bound, relative", better="lower"),
}


@register("distance_matrix", "pairs", metrics=METRICS, defaults_of=(Pairing, spectral_embedding))
def pairs_matrix(
    surfaces: dict[Member, Surface],
    systems: dict[Member, EigenSystem],
    *,
    method: Annotated[
        Literal[
            "mean_hausdorff",
            "hausdorff",
            "wasserstein",
            "block_orthogonal",
            "least_over_blocks",
            "sup_inf",
            "sup_inf_mean",
        ],
        Field(description="distance of a pair; the last three try bases on a grid"),
    ],
    n: Annotated[int, Field(ge=1, le=200, description="number of eigenfunctions")] = 4,
    weighting: Annotated[
        Literal["global_point", "biharmonic", "heat_kernel", "diffusion"],
        Field(description="weight of each eigenfunction: (6.4), 1/lambda, or (3.11)"),
    ],
    time: Annotated[float, Field(gt=0, le=100, description="time of heat kernel and diffusion, in units of the area")],
    exact: Annotated[bool, Field(description="search signs on all points with proof, or on samples only")],
    samples: Annotated[
        int, Field(ge=10, le=100000, description="points of each surface in searches, transport and on grids")
    ],
    limit: Annotated[int, Field(ge=2, le=1000000, description="most evaluations of a search for signs")],
    gap: Annotated[
        float, Field(ge=0, lt=1, description="eigenvalues nearer than this, relatively, belong to one block")
    ],
    angles: Annotated[int, Field(ge=1, le=1000, description="bases of each plane on a grid")],
    seed: Annotated[int, Field(ge=0, description="seed of samples and bases")],
) -> DistanceMatrix:
    """Spectral distance of every pair, the worst triangle, and the share of pairs proved least."""
    chosen = {
        "method": method,
        "n": n,
        "weighting": weighting,
        "time": time,
        "exact": exact,
        "samples": samples,
        "limit": limit,
        "gap": gap,
        "angles": angles,
        "seed": seed,
    }
    parts = {name: chosen.pop(name) for name in ("n", "weighting", "time")}
    pairing = Pairing(**chosen)
    embeddings = {
        member.label: spectral_embedding(systems[member], surface.mesh.vertex_areas, **parts)
        for member, surface in surfaces.items()
    }
    values, bounds = pairwise_distances(embeddings, pairing)
    count, labels = len(values), tuple(embeddings)
    sizes = {"pairs": float(comb(count, 2)), "triples": float(comb(count, 3)), "largest_distance": float(values.max())}
    metrics = {**triangle_metrics(values), **sizes, **gap_metrics(values, bounds)}
    searched = method in ("mean_hausdorff", "hausdorff", "wasserstein")
    notes = unproved_pairs(labels, values, bounds) if searched else ()
    return DistanceMatrix(
        labels,
        values,
        classes=tuple(member.class_name for member in surfaces),
        groups=tuple(member.group for member in surfaces),
        name=f"{method} distance, n = {n}",
        metrics=metrics,
        notes=notes,
    )
