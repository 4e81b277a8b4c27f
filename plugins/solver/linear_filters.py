"""Linear filters of maps: what total variation is compared with."""

from dataclasses import replace
from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.arrays import Floats
from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.smoothing.heat_polynomial import heat_polynomial
from surfexp.smoothing.neighbour_mean import neighbour_mean
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.heat_kernel import diffuse
from surfexp.variational.image import Image
from surfexp.variational.solution import Solution
from surfexp.variational.truth_metrics import RESTORATION_METRICS, restoration_metrics

METRICS = {
    "mean_drift": Metric("change of the mean", "unit of the image", "lower"),
    **RESTORATION_METRICS,
}
POLYNOMIAL_METRICS = {
    "time": Metric("end time", "unit of length squared"),
    "degree": Metric("degree of the polynomial", better="lower"),
    "filter_error_bound": Metric(
        "largest possible distance to the heat flow over that of the image, mass norm", better="lower"
    ),
    **METRICS,
}


@register("solver", "neighbour_mean", metrics=METRICS)
def neighbour_mean_solver(
    image: Image,
    operator: SurfaceOperator,
    *,
    iterations: Annotated[int, Field(ge=0, le=100000, description="means over each vertex and its neighbours")] = 10,
) -> Solution:
    """Means over each vertex and its neighbours, all of one weight, as imaging packages smooth maps."""
    values = neighbour_mean(operator.faces, image.values, iterations)
    return _filtered("neighbour mean", values, image, operator, iterations)


@register("solver", "heat_polynomial", metrics=POLYNOMIAL_METRICS, defaults_of=heat_polynomial)
def heat_polynomial_solver(
    image: Image,
    operator: SurfaceOperator,
    *,
    width: Annotated[
        float, Field(gt=0, description="standard deviation sqrt(2 time) of the kernel in edge lengths")
    ] = 2.0,
    tolerance: Annotated[float, Field(gt=0, lt=1, description="bound of the relative error")],
) -> Solution:
    """Heat flow by Chebyshev polynomials of the Laplacian, with a bound of the error and without a linear system."""
    time = 0.5 * (width * operator.edge_length) ** 2
    values, degree, bound = heat_polynomial(operator, image.values, time, tolerance)
    solution = _filtered("heat kernel", values, image, operator, degree)
    return replace(
        solution, metrics=solution.metrics | {"time": time, "degree": float(degree), "filter_error_bound": bound}
    )


@register("solver", "truncated_modes", metrics=METRICS)
def truncated_modes_solver(image: Image, operator: SurfaceOperator, eigensolver: EigenSystem) -> Solution:
    """What the lowest eigenfunctions see of the image, without all above them."""
    values = diffuse(eigensolver, mass_matrix(operator), image.values, 0.0)
    return _filtered("truncated modes", values, image, operator, 1)


def _filtered(name: str, values: Floats, image: Image, operator: SurfaceOperator, iterations: int) -> Solution:
    drift = float(np.abs(operator.mass @ (values - image.values)).max() / operator.mass.sum())
    metrics = {"mean_drift": drift, **restoration_metrics(image, operator, values)}
    flat = values.reshape(len(values), -1)
    energy = 0.5 * float((flat * (stiffness(operator) @ flat)).sum())
    facts = {"model": name, "solver": "linear filter", "reason": "end", "iterations": iterations}
    return Solution(values, energy, metrics=metrics, **facts)
