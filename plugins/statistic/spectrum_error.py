"""Errors of spectra against exact ones, theorem 3.2.1."""

from typing import Literal

from pydantic import Field

from surfexp.contract.member import Member
from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.statistics.statistic import Statistic
from surfexp.studies.spectra.spectrum_error import convergence_orders, spectrum_error


class SpectrumError(Options):
    """Which values are looked at."""

    low: int = Field(8, ge=1, le=1000, description="values that error_low looks at")
    high: int = Field(24, ge=1, le=1000, description="values that error_high looks at")


SPECTRUM_ERROR_METRICS = {
    "error_low": Metric("largest relative error of the lowest eigenvalues", better="lower"),
    "error_high": Metric("largest relative error of more eigenvalues", better="lower"),
    "below_exact": Metric("eigenvalues below the exact ones", better="lower"),
    "edge_length": Metric("mean length of the edges", "unit of length"),
    "degrees_of_freedom": Metric("unknowns of the discrete problem"),
    "complete": Metric("1 where no eigenvalue is proved to be missing, else 0", better="higher"),
}


@register(
    "statistic",
    "spectrum_error",
    metrics=SPECTRUM_ERROR_METRICS,
    accepts={"surface": ("icosphere", "disk", "rectangle", "flat_torus")},
)
def spectrum_error_statistic(options: SpectrumError, *, surface: Surface, eigensolver: EigenSystem) -> Statistic:
    """Relative errors of the eigenvalues of a sphere, disk, rectangle or flat torus against the exact ones."""
    return spectrum_error(surface, eigensolver, options.low, options.high)


class Orders(Options):
    """Which error is fitted."""

    metric: Literal["error_low", "error_high"] = Field("error_high", description="metric that is fitted")


CONVERGENCE_ORDERS_METRICS = {
    "order {line}": Metric("order of convergence in the edge length", better="higher"),
    "finest {line}": Metric("error on the finest mesh", better="lower"),
}


@register("statistic", "convergence_orders", metrics=CONVERGENCE_ORDERS_METRICS)
def orders_statistic(options: Orders, *, errors: dict[Member, Statistic]) -> Statistic:
    """Orders of convergence in the edge length, fitted for each method of an axis "method @ level"."""
    return convergence_orders(errors, options.metric)
