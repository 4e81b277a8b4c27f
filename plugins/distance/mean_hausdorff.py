"""The spectral distance of chapter 6, exact over signs, with its certificate."""

from dataclasses import replace
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.embedding.distance import Distance
from surfexp.embedding.face_distance import distance_on_faces
from surfexp.embedding.spectral_distance import spectral_distance
from surfexp.embedding.spectral_embedding import SpectralEmbedding, spectral_embedding
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem

N = Annotated[int, Field(ge=1, le=200, description="number of eigenfunctions")]
Weighting = Annotated[
    Literal["global_point", "biharmonic", "heat_kernel", "diffusion"],
    Field(description="weight of each eigenfunction: (6.4), 1/lambda, or (3.11)"),
]
Time = Annotated[float, Field(gt=0, le=100, description="time of heat kernel and diffusion, in units of the area")]
Seed = Annotated[int, Field(ge=0, description="seed of samples and order")]
Reading = Annotated[
    Literal["inf_of_max", "max_of_inf"],
    Field(description="one choice of signs for both directions, or one for each as published in (6.16)"),
]
Undecided = Annotated[Literal["absolute", "prefix"], Field(description="bound of the search over signs")]
Samples = Annotated[int, Field(ge=10, le=100000, description="points on which the search starts, drawn by area")]
Limit = Annotated[int, Field(ge=2, le=1000000, description="most evaluations on all points")]
Exact = Annotated[bool, Field(description="search on all points with proof, or on samples only")]
Faces = Annotated[bool, Field(description="measure the distance to faces too, in the signs that are best for vertices")]


METRICS = {
    "forward": Metric("mean distance from the source to the target"),
    "backward": Metric("mean distance from the target to the source"),
    "hausdorff": Metric("largest distance either way"),
    "same_signs": Metric("1 where all searches found the same signs, else 0", better="higher"),
    "distance to faces": Metric("the distance to triangles in place of vertices"),
    "gap of vertices": Metric("distance to vertices less that to triangles", better="lower"),
    "edge length": Metric("mean length of the edges over the root of the area"),
}


@register("distance", "mean_hausdorff", metrics=METRICS, defaults_of=(spectral_distance, spectral_embedding))
def mean_hausdorff_distance(
    source_surface: Surface,
    target_surface: Surface,
    source: EigenSystem,
    target: EigenSystem,
    *,
    n: N = 10,
    weighting: Weighting,
    time: Time,
    seed: Seed,
    reading: Reading,
    undecided: Undecided,
    samples: Samples,
    limit: Limit,
    exact: Exact,
    faces: Faces = False,
) -> Distance:
    """Spectral distance d_n of (6.17) by an exact search over the signs of the eigenfunctions."""
    pair = _embedded(source_surface, target_surface, source, target, n, weighting, time)
    found = spectral_distance(
        *pair,
        reading=reading,
        undecided=undecided,
        samples=samples,
        limit=limit,
        exact=exact,
        seed=seed,
        summary="mean",
    )
    return _with_faces(found, pair, source_surface, target_surface, "mean") if faces else found


@register("distance", "hausdorff", metrics=METRICS, defaults_of=(spectral_distance, spectral_embedding))
def hausdorff_distance(
    source_surface: Surface,
    target_surface: Surface,
    source: EigenSystem,
    target: EigenSystem,
    *,
    n: N = 10,
    weighting: Weighting,
    time: Time,
    seed: Seed,
    reading: Reading,
    undecided: Undecided,
    samples: Samples,
    limit: Limit,
    exact: Exact,
    faces: Faces = False,
) -> Distance:
    """Hausdorff distance of the embeddings, least over signs: obeys the triangle inequality."""
    pair = _embedded(source_surface, target_surface, source, target, n, weighting, time)
    found = spectral_distance(
        *pair,
        reading=reading,
        undecided=undecided,
        samples=samples,
        limit=limit,
        exact=exact,
        seed=seed,
        summary="largest",
    )
    return _with_faces(found, pair, source_surface, target_surface, "largest") if faces else found


def _embedded(
    source_surface: Surface,
    target_surface: Surface,
    source: EigenSystem,
    target: EigenSystem,
    n: int,
    weighting: Weighting,
    time: float,
) -> list[SpectralEmbedding]:
    return [
        spectral_embedding(system, surface.mesh.vertex_areas, n, weighting, time)
        for system, surface in ((source, source_surface), (target, target_surface))
    ]


def _with_faces(
    found: Distance,
    pair: list[SpectralEmbedding],
    source_surface: Surface,
    target_surface: Surface,
    summary: Literal["mean", "largest"],
) -> Distance:
    meshes = source_surface.mesh, target_surface.mesh
    on_faces = distance_on_faces(pair[0], pair[1].rotated(found.basis), meshes[0].faces, meshes[1].faces, summary)
    edges = max(mesh.edge_length / np.sqrt(mesh.area) for mesh in meshes)
    extra = {"distance to faces": on_faces, "gap of vertices": found.value - on_faces, "edge length": edges}
    return replace(found, metrics={**found.metrics, **extra})
