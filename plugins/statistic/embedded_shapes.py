"""What the embedding by the first eigenfunctions makes of a sphere, and of regions of two cortices."""

from collections.abc import Sequence
from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.arrays import Integers
from surfexp.contract.metric import Metric
from surfexp.embedding.region_separation import region_separation
from surfexp.embedding.spectral_distance import spectral_distance
from surfexp.embedding.spectral_embedding import spectral_embedding
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.statistics.statistic import Statistic

ROUNDNESS_METRICS = {
    "mean_radius": Metric("mean distance from the origin"),
    "radius_spread": Metric("standard deviation of the distance over its mean"),
}


@register("statistic", "embedded_roundness", metrics=ROUNDNESS_METRICS)
def embedded_roundness_statistic(surface: Surface, eigensolver: EigenSystem) -> Statistic:
    """Mean and spread of the distance of a surface from the origin in its first three eigenfunctions (6.4)."""
    embedding = spectral_embedding(eigensolver, surface.mesh.vertex_areas, 3)
    radii = np.linalg.norm(embedding.points, axis=1)
    mean = float(radii @ embedding.weights)
    spread = float(np.sqrt((radii - mean) ** 2 @ embedding.weights)) / mean
    return Statistic(f"embedded {surface.name}", metrics={"mean_radius": mean, "radius_spread": spread})


SEPARATION_METRICS = {
    "found, in space": Metric("share of regions nearest to their own on the other side, in space"),
    "found, n = {n}": Metric("share of regions nearest to their own on the other side", better="higher"),
    "between over distance, n = {n}": Metric(
        "distance between regions over the distance of the surfaces", better="higher"
    ),
    "between over within, n = {n}": Metric(
        "distance between regions over that of one region on both sides", better="higher"
    ),
}


@register("statistic", "region_separation", metrics=SEPARATION_METRICS)
def region_separation_statistic(
    source_surface: Surface,
    source: EigenSystem,
    target_surface: Surface,
    target: EigenSystem,
    *,
    sizes: Annotated[Sequence[int], Field(description="numbers n of eigenfunctions")] = [1, 2, 3, 4, 6, 10],
) -> Statistic:
    """Distances between labelled regions in the optimal embedding by n functions, and in space, against d_n (6.17)."""
    meshes = source_surface.mesh, target_surface.mesh
    labels = [_regions(item) for item in (source_surface, target_surface)]
    areas = [mesh.vertex_areas / mesh.area for mesh in meshes]
    rows = []
    for n in sizes:
        first, second = (
            spectral_embedding(system, mesh.vertex_areas, n)
            for system, mesh in zip((source, target), meshes, strict=True)
        )
        best = spectral_distance(first, second)
        there = region_separation(
            first.points, areas[0], labels[0], second.rotated(best.basis).points, areas[1], labels[1]
        )
        rows.append((there.between / best.value, there.between / there.within, there.found))
    space = region_separation(meshes[0].vertices, areas[0], labels[0], meshes[1].vertices, areas[1], labels[1])
    table = np.array(rows)
    metrics = {"found, in space": space.found}
    for name, column in zip(("between over distance", "between over within", "found"), table.T, strict=True):
        metrics |= {f"{name}, n = {n}": float(value) for n, value in zip(sizes, column, strict=True)}
    columns = {"n": np.array(sizes, float), "between over distance": table[:, 0], "found": table[:, 2]}
    return Statistic("regions in the optimal embedding", columns, metrics=metrics)


def _regions(surface: Surface) -> Integers:
    """Regions from 0; -1 where the label is 0, which no region claims."""
    if surface.truth.labels is None:
        raise ValueError(f"surface {surface.name!r} has no true labels: take labelled_fsaverage5")
    return surface.truth.labels - 1
