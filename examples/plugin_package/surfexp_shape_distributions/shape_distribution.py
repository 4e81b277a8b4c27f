"""The shape distribution D2 of Osada, Funkhouser, Chazelle and Dobkin (ACM Transactions on Graphics, 2002)."""

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.signature import Signature
from surfexp_shape_distributions.distances import distance_quantiles


class ShapeDistribution(Options):
    """How finely the distribution is known."""

    count: int = Field(64, ge=2, le=1024, description="number of quantiles")
    pairs: int = Field(100_000, ge=1000, le=10_000_000, description="number of random pairs of points")
    seed: int = Field(0, ge=0, description="seed of the pairs")


METRICS = {
    "median_distance": Metric("median distance between two points of the surface over the root of its area"),
}


@register("signature", "shape_distribution", metrics=METRICS)
def shape_distribution(options: ShapeDistribution, *, surface: Surface) -> Signature:
    """Quantiles of the distance through space between two random points, over the root of the area."""
    mesh = surface.mesh
    values = distance_quantiles(mesh.vertices, mesh.faces, **dict(options)) / np.sqrt(mesh.area)
    return Signature(values, "shape_distribution", metrics={"median_distance": float(np.median(values))})
