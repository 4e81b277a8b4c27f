"""Distributions of point signatures over a surface."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.shape_distributions import (
    embedding_distances,
    heat_distribution,
    scaled_heat_trace,
    wave_distribution,
)
from surfexp.spectrum.signature import Signature

METRICS = {
    "length": Metric("entries"),
}


@register("signature", "distribution", metrics=METRICS, defaults_of=embedding_distances)
def distribution_signature(
    surface: Surface,
    eigensolver: EigenSystem,
    *,
    quantity: Annotated[Literal["heat_trace", "hks", "wks", "gps"], Field(description="what is gathered")] = "hks",
    seed: Annotated[int, Field(ge=0, description="seed of the points that gps draws")],
) -> Signature:
    """Heat trace, or the distribution over the surface of HKS, WKS or distances in the GPS embedding."""
    areas = surface.mesh.vertex_areas
    values = {
        "heat_trace": lambda: scaled_heat_trace(eigensolver),
        "hks": lambda: heat_distribution(eigensolver, areas),
        "wks": lambda: wave_distribution(eigensolver, areas),
        "gps": lambda: embedding_distances(eigensolver, areas, seed),
    }[quantity]()
    return Signature(values, quantity, metrics={"length": float(len(values))})
