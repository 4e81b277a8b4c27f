"""Curves of the geodesic error of maps whose truth is known, as in the literature on functional maps."""

from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.embedding.distance import Distance
from surfexp.embedding.geodesic_error import geodesic_errors, share_within
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.statistics.statistic import Statistic

METRICS = {
    "mean, {map}": Metric("mean geodesic error over the root of the area", better="lower"),
    "within .05, {map}": Metric("share of the area with an error of at most .05", better="higher"),
}


@register("statistic", "geodesic_errors", metrics=METRICS, defaults_of=geodesic_errors)
def geodesic_errors_statistic(
    source_surface: Surface,
    target_surface: Surface,
    maps: dict[str, Distance],
    *,
    samples: Annotated[int, Field(ge=1, le=100000, description="vertices of the target, drawn by area")],
    largest: Annotated[float, Field(gt=0, le=10, description="end of the curves, in square roots of the area")] = 0.2,
    steps: Annotated[int, Field(ge=1, le=1000, description="points of the curves after 0")] = 20,
    seed: Annotated[int, Field(ge=0, description="seed of the draw")],
) -> Statistic:
    """Share of the target that each map sends within a geodesic distance of the true place on the source."""
    truth = target_surface.truth
    if truth.origin is None or truth.template != source_surface.mesh.identity:
        raise ValueError(
            f"the true vertices of {target_surface.name!r} on {source_surface.name!r} are not known: take surface disguised"
        )
    errors = geodesic_errors(
        source_surface.mesh,
        target_surface.mesh.vertex_areas,
        truth.origin,
        {name: found.correspondence for name, found in maps.items()},
        samples,
        seed,
    )
    bounds = np.linspace(0.0, largest, steps + 1)
    columns = {"error": bounds, **{name: share_within(values, bounds) for name, values in errors.items()}}
    metrics = {f"mean, {name}": float(values.mean()) for name, values in errors.items()}
    metrics |= {f"within .05, {name}": float((values <= 0.05).mean()) for name, values in errors.items()}
    return Statistic("geodesic errors of maps", columns, (), metrics)
