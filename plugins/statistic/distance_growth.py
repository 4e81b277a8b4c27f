"""Growth of the spectral distance with the number of eigenfunctions, on analytic spectra, (6.19)."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.embedding.analytic_spectra import sphere_embedding, spheroid_embedding, torus_embedding
from surfexp.lab.registry.registry import register
from surfexp.statistics.statistic import Statistic
from surfexp.studies.distances.distance_growth import distance_brackets, logarithmic_slope, squared_norms

METRICS = {
    "lower bound": Metric("proved lower bound of the distance at the largest n"),
    "upper bound": Metric("upper bound of the distance at the largest n"),
    "norm slope times 4 pi": Metric("growth of the mean squared norm over (1/4 pi) ln n"),
    "growth of the norm, last doubling": Metric("relative growth of the mean squared norm"),
    "growth of the upper bound, last doubling": Metric("relative growth of the upper bound"),
}


@register("statistic", "distance_growth", metrics=METRICS, defaults_of=torus_embedding)
def distance_growth_statistic(
    *,
    family: Annotated[
        Literal["torus", "spheroid", "sphere"],
        Field(description="flat tori, ellipsoids of revolution, or sphere against ellipsoid of revolution"),
    ] = "torus",
    first: Annotated[
        float, Field(gt=0.1, lt=10, description="ratio of the torus's sides, or axis of the ellipsoid; first surface")
    ] = 1.1,
    second: Annotated[float, Field(gt=0.1, lt=10, description="the same of the second surface")] = 1.15,
    largest: Annotated[
        int, Field(ge=20, le=2000, description="most eigenfunctions; sizes double up to it from the left")
    ] = 400,
    weighting: Annotated[Literal["global_point", "biharmonic"], Field(description="1/sqrt(lambda) (6.4), or 1/lambda")],
) -> Statistic:
    """Bounds of d_n and the mean squared norm of the embedding for growing n, and their growth with ln n."""
    sizes = sorted({round(largest / 2**k) for k in range(int(np.log2(largest / 4)) + 1)})
    make = torus_embedding if family == "torus" else spheroid_embedding
    second_error = make(second, largest, weighting=weighting)
    if family == "sphere":
        first_error = sphere_embedding((int(np.ceil(np.sqrt(largest + 1)))) ** 2 - 1, 3600, weighting)
        first_error = first_error.truncated(largest)
    else:
        first_error = make(first, largest, weighting=weighting)
    lower, upper = distance_brackets(first_error, second_error, sizes)
    norms = squared_norms(first_error, sizes)
    middle = len(sizes) // 2
    metrics = {
        "lower bound": float(lower[-1]),
        "upper bound": float(upper[-1]),
        "norm slope times 4 pi": 4.0 * np.pi * logarithmic_slope(sizes[middle - 1 :], norms[middle - 1 :]),
        "growth of the norm, last doubling": float(norms[-1] / norms[-2] - 1.0),
        "growth of the upper bound, last doubling": float(upper[-1] / upper[-2] - 1.0),
    }
    columns = {"n": np.array(sizes, float), "lower bound": lower, "upper bound": upper, "squared norm": norms}
    return Statistic(f"{family}, {weighting.replace('_', ' ')}", columns, metrics=metrics)
