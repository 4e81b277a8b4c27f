"""Linear filters of maps: what total variation is compared with."""

from dataclasses import replace

import numpy as np
from pydantic import Field

from surfexp.contract.arrays import Floats
from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
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


class NeighbourMean(Options):
    """How often."""

    iterations: int = Field(10, ge=0, le=100000, description="means over each vertex and its neighbours")


@register("solver", "neighbour_mean", metrics=METRICS)
def neighbour_mean_solver(options: NeighbourMean, *, image: Image, operator: SurfaceOperator) -> Solution:
    """Means over each vertex and its neighbours, all of one weight, as imaging packages smooth maps."""
    values = neighbour_mean(operator.faces, image.values, options.iterations)
    return _filtered("neighbour mean", values, image, operator, options.iterations)


class HeatPolynomial(Options):
    """How wide, and how exactly."""

    width: float = Field(2.0, gt=0, description="standard deviation sqrt(2 time) of the kernel in edge lengths")
    tolerance: float = Field(1e-8, gt=0, lt=1, description="bound of the relative error")


@register("solver", "heat_polynomial", metrics=POLYNOMIAL_METRICS)
def heat_polynomial_solver(options: HeatPolynomial, *, image: Image, operator: SurfaceOperator) -> Solution:
    """Heat flow by Chebyshev polynomials of the Laplacian, with a bound of the error and without a linear system."""
    time = 0.5 * (options.width * operator.edge_length) ** 2
    values, degree, bound = heat_polynomial(operator, image.values, time, options.tolerance)
    solution = _filtered("heat kernel", values, image, operator, degree)
    return replace(
        solution, metrics=solution.metrics | {"time": time, "degree": float(degree), "filter_error_bound": bound}
    )


class TruncatedModes(Options):
    """Nothing to choose: the number of modes is that of the eigensolver."""


@register("solver", "truncated_modes", metrics=METRICS)
def truncated_modes_solver(
    options: TruncatedModes, *, image: Image, operator: SurfaceOperator, eigensolver: EigenSystem
) -> Solution:
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
