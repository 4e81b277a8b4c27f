"""The shape distribution D2 of Osada, Funkhouser, Chazelle and Dobkin (ACM Transactions on Graphics, 2002)."""

from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.signature import Signature
from surfexp_shape_distributions.distances import distance_quantiles

METRICS = {
    "median_distance": Metric("median distance between two points of the surface over the root of its area"),
}


@register("signature", "shape_distribution", metrics=METRICS)
def shape_distribution(
    surface: Surface,
    *,
    count: Annotated[int, Field(ge=2, le=1024, description="number of quantiles")] = 64,
    pairs: Annotated[int, Field(ge=1000, le=10_000_000, description="number of random pairs of points")] = 100_000,
    seed: Annotated[int, Field(ge=0, description="seed of the pairs")] = 0,
) -> Signature:
    """Quantiles of the distance through space between two random points, over the root of the area."""
    mesh = surface.mesh
    values = distance_quantiles(mesh.vertices, mesh.faces, count, pairs, seed) / np.sqrt(mesh.area)
    return Signature(values, "shape_distribution", metrics={"median_distance": float(np.median(values))})
