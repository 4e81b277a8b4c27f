"""Spectral distances of a synthetic population to its template, in blocks."""

from collections.abc import Iterator
from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.mesh.surface import Surface
from surfexp.populations.synthetic_subject import SIDES, synthetic_subject
from surfexp.statistics.statistic import Statistic
from surfexp_studies.template_distances.template_distances import template_distances

METRICS = {
    "surfaces": Metric("number of surfaces"),
    "mean distance": Metric("mean distance to the template"),
    "largest distance": Metric("largest distance to the template"),
    "doubtful": Metric("surfaces whose signs depend on the samples", better="lower"),
}


@register("statistic", "template_distances", metrics=METRICS, defaults_of=(template_distances, synthetic_subject))
def template_distances_statistic(
    template: Surface,
    *,
    subjects: Annotated[int, Field(ge=1, le=2000, description="subjects of this block, two hemispheres each")] = 5,
    first: Annotated[int, Field(ge=0, le=1000000, description="number of the block's first subject")] = 0,
    n: Annotated[int, Field(ge=1, le=200, description="number of eigenfunctions")],
    exact: Annotated[bool, Field(description="prove the signs on all points, or take those of samples")],
    samples: Annotated[int, Field(ge=10, le=100000, description="points on which signs are searched, drawn by area")],
    strain: Annotated[float, Field(ge=0, le=0.3, description="root mean square strain of the random deformations")],
    seed: Annotated[int, Field(ge=0, description="seed of the population")],
) -> Statistic:
    """Spectral distance of each hemisphere of a block of a synthetic population to the template."""
    numbers = [(first + k, side) for k in range(subjects) for side in SIDES]

    def surfaces() -> Iterator[Surface]:
        for number, side in numbers:
            yield synthetic_subject(template, number, side, strain, seed=seed)

    count = len(numbers)
    columns = template_distances(
        template,
        surfaces(),
        n,
        exact,
        samples,
        lambda done: report_progress(done, 1.0 - done / count),
    )
    values = columns["distance"]
    metrics = {
        "surfaces": float(count),
        "mean distance": float(values.mean()),
        "largest distance": float(values.max()),
        "doubtful": float(columns["doubtful"].sum()),
    }
    keys = {
        "subject": np.array([number for number, _ in numbers], float),
        "side": np.array([SIDES.index(side) for _, side in numbers], float),
    }
    rows = tuple(f"subject {number}, {side}" for number, side in numbers)
    return Statistic("distances to the template", {**keys, **columns}, rows, metrics)
