"""The Wasserstein distance of embedded area measures, least over signs."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.embedding.distance import Distance
from surfexp.embedding.spectral_embedding import spectral_embedding
from surfexp.embedding.wasserstein import wasserstein_distance
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem

METRICS = {
    "samples": Metric("samples of each surface"),
}


@register("distance", "wasserstein", metrics=METRICS, defaults_of=(wasserstein_distance, spectral_embedding))
def wasserstein_plugin(
    source_surface: Surface,
    target_surface: Surface,
    source: EigenSystem,
    target: EigenSystem,
    *,
    n: Annotated[int, Field(ge=1, le=200, description="number of eigenfunctions")] = 4,
    weighting: Annotated[
        Literal["global_point", "biharmonic", "heat_kernel", "diffusion"],
        Field(description="weight of each eigenfunction: (6.4), 1/lambda, or (3.11)"),
    ],
    time: Annotated[float, Field(gt=0, le=100, description="time of heat kernel and diffusion, in units of the area")],
    samples: Annotated[int, Field(ge=10, le=5000, description="points of each surface, drawn by area")],
    limit: Annotated[int, Field(ge=2, le=1000000, description="most transport problems")],
    transport: Annotated[Literal["exact", "sinkhorn"], Field(description="network simplex or entropic plans")],
    entropy: Annotated[float, Field(gt=0, le=10, description="of Sinkhorn's plans, as a share of the mean distance")],
    seed: Annotated[int, Field(ge=0, description="seed of the samples")],
) -> Distance:
    """Least mean distance over which one area measure is carried to the other: obeys the triangle inequality."""
    chosen = {
        "n": n,
        "weighting": weighting,
        "time": time,
        "samples": samples,
        "limit": limit,
        "transport": transport,
        "entropy": entropy,
        "seed": seed,
    }
    parts = {name: chosen.pop(name) for name in ("n", "weighting", "time")}
    pair = (
        spectral_embedding(system, surface.mesh.vertex_areas, **parts)
        for system, surface in ((source, source_surface), (target, target_surface))
    )
    return wasserstein_distance(*pair, **chosen)
