"""The spectral distance of chapter 6, exact over signs, with its certificate."""

from dataclasses import replace
from typing import Literal

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.embedding.distance import Distance
from surfexp.embedding.face_distance import distance_on_faces
from surfexp.embedding.spectral_distance import spectral_distance
from surfexp.embedding.spectral_embedding import spectral_embedding
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem


class Embedded(Options):
    """The embedding that is compared."""

    n: int = Field(10, ge=1, le=200, description="number of eigenfunctions")
    weighting: Literal["global_point", "biharmonic", "heat_kernel", "diffusion"] = Field(
        "global_point", description="weight of each eigenfunction: (6.4), 1/lambda, or (3.11)"
    )
    time: float = Field(0.02, gt=0, le=100, description="time of heat kernel and diffusion, in units of the area")
    seed: int = Field(0, ge=0, description="seed of samples and order")


class MeanHausdorff(Embedded):
    """Distances that are minimised over signs."""

    reading: Literal["inf_of_max", "max_of_inf"] = Field(
        "inf_of_max", description="one choice of signs for both directions, or one for each as published in (6.16)"
    )
    undecided: Literal["absolute", "prefix"] = Field("absolute", description="bound of the search over signs")
    samples: int = Field(1500, ge=10, le=100000, description="points on which the search starts, drawn by area")
    limit: int = Field(2000, ge=2, le=1000000, description="most evaluations on all points")
    exact: bool = Field(True, description="search on all points with proof, or on samples only")
    faces: bool = Field(False, description="measure the distance to faces too, in the signs that are best for vertices")


METRICS = {
    "forward": Metric("mean distance from the source to the target"),
    "backward": Metric("mean distance from the target to the source"),
    "hausdorff": Metric("largest distance either way"),
    "same_signs": Metric("1 where all searches found the same signs, else 0", better="higher"),
    "distance to faces": Metric("the distance to triangles in place of vertices"),
    "gap of vertices": Metric("distance to vertices less that to triangles", better="lower"),
    "edge length": Metric("mean length of the edges over the root of the area"),
}


@register("distance", "mean_hausdorff", metrics=METRICS)
def mean_hausdorff_distance(
    options: MeanHausdorff,
    *,
    source_surface: Surface,
    target_surface: Surface,
    source: EigenSystem,
    target: EigenSystem,
) -> Distance:
    """Spectral distance d_n of (6.17) by an exact search over the signs of the eigenfunctions."""
    return _distance(options, source_surface, target_surface, source, target, "mean")


@register("distance", "hausdorff", metrics=METRICS)
def hausdorff_distance(
    options: MeanHausdorff,
    *,
    source_surface: Surface,
    target_surface: Surface,
    source: EigenSystem,
    target: EigenSystem,
) -> Distance:
    """Hausdorff distance of the embeddings, least over signs: obeys the triangle inequality."""
    return _distance(options, source_surface, target_surface, source, target, "largest")


def _distance(
    options: MeanHausdorff,
    source_surface: Surface,
    target_surface: Surface,
    source: EigenSystem,
    target: EigenSystem,
    summary: Literal["mean", "largest"],
) -> Distance:
    chosen = dict(options)
    parts = {name: chosen.pop(name) for name in ("n", "weighting", "time")}
    to_faces = chosen.pop("faces")
    first, second = (
        spectral_embedding(system, surface.mesh.vertex_areas, **parts)
        for system, surface in ((source, source_surface), (target, target_surface))
    )
    found = spectral_distance(first, second, **chosen, summary=summary)
    if not to_faces:
        return found
    meshes = source_surface.mesh, target_surface.mesh
    on_faces = distance_on_faces(first, second.rotated(found.basis), meshes[0].faces, meshes[1].faces, summary)
    edges = max(mesh.edge_length / np.sqrt(mesh.area) for mesh in meshes)
    extra = {"distance to faces": on_faces, "gap of vertices": found.value - on_faces, "edge length": edges}
    return replace(found, metrics={**found.metrics, **extra})
