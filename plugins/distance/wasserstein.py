"""The Wasserstein distance of embedded area measures, least over signs."""

from typing import Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.embedding.distance import Distance
from surfexp.embedding.spectral_embedding import spectral_embedding
from surfexp.embedding.wasserstein import wasserstein_distance
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem


class Wasserstein(Options):
    """Samples and transport."""

    n: int = Field(4, ge=1, le=200, description="number of eigenfunctions")
    weighting: Literal["global_point", "biharmonic", "heat_kernel", "diffusion"] = Field(
        "global_point", description="weight of each eigenfunction: (6.4), 1/lambda, or (3.11)"
    )
    time: float = Field(0.02, gt=0, le=100, description="time of heat kernel and diffusion, in units of the area")
    samples: int = Field(200, ge=10, le=5000, description="points of each surface, drawn by area")
    limit: int = Field(2000, ge=2, le=1000000, description="most transport problems")
    transport: Literal["exact", "sinkhorn"] = Field("exact", description="network simplex or entropic plans")
    entropy: float = Field(0.02, gt=0, le=10, description="of Sinkhorn's plans, as a share of the mean distance")
    seed: int = Field(0, ge=0, description="seed of the samples")


METRICS = {
    "samples": Metric("samples of each surface"),
}


@register("distance", "wasserstein", metrics=METRICS)
def wasserstein_plugin(
    options: Wasserstein, *, source_surface: Surface, target_surface: Surface, source: EigenSystem, target: EigenSystem
) -> Distance:
    """Least mean distance over which one area measure is carried to the other: obeys the triangle inequality."""
    chosen = dict(options)
    parts = {name: chosen.pop(name) for name in ("n", "weighting", "time")}
    pair = (
        spectral_embedding(system, surface.mesh.vertex_areas, **parts)
        for system, surface in ((source, source_surface), (target, target_surface))
    )
    return wasserstein_distance(*pair, **chosen)
