"""Distributions of point signatures over a surface."""

from typing import Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.shape_distributions import (
    embedding_distances,
    heat_distribution,
    scaled_heat_trace,
    wave_distribution,
)
from surfexp.spectrum.signature import Signature


class Distribution(Options):
    """Which quantity is gathered over the surface."""

    quantity: Literal["heat_trace", "hks", "wks", "gps"] = Field("hks", description="what is gathered")
    seed: int = Field(0, ge=0, description="seed of the points that gps draws")


METRICS = {
    "length": Metric("entries"),
}


@register("signature", "distribution", metrics=METRICS)
def distribution_signature(options: Distribution, *, surface: Surface, eigensolver: EigenSystem) -> Signature:
    """Heat trace, or the distribution over the surface of HKS, WKS or distances in the GPS embedding."""
    areas = surface.mesh.vertex_areas
    values = {
        "heat_trace": lambda: scaled_heat_trace(eigensolver),
        "hks": lambda: heat_distribution(eigensolver, areas),
        "wks": lambda: wave_distribution(eigensolver, areas),
        "gps": lambda: embedding_distances(eigensolver, areas, options.seed),
    }[options.quantity]()
    return Signature(values, options.quantity, metrics={"length": float(len(values))})
