"""Errors of spectra against exact ones, theorem 3.2.1."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp_studies.convergence.spectrum_error import convergence_orders, spectrum_error

SPECTRUM_ERROR_METRICS = {
    "error_low": Metric("largest relative error of the lowest eigenvalues", better="lower"),
    "error_high": Metric("largest relative error of more eigenvalues", better="lower"),
    "below_exact": Metric("eigenvalues below the exact ones", better="lower"),
    "edge_length": Metric("mean length of the edges", "unit of length"),
    "degrees_of_freedom": Metric("unknowns of the discrete problem"),
    "complete": Metric("1 where it is proved that no eigenvalue is missing, else 0", better="higher"),
}


register(
    "statistic",
    "spectrum_error",
    metrics=SPECTRUM_ERROR_METRICS,
    accepts={"surface": ("icosphere", "disk", "rectangle", "flat_torus")},
    options={
        "low": Field(ge=1, le=1000, description="values that error_low looks at"),
        "high": Field(ge=1, le=1000, description="values that error_high looks at"),
    },
    names={"system": "eigensolver"},
)(spectrum_error)


CONVERGENCE_ORDERS_METRICS = {
    "order {line}": Metric("order of convergence in the edge length", better="higher"),
    "finest {line}": Metric("error on the finest mesh", better="lower"),
}


register(
    "statistic",
    "convergence_orders",
    metrics=CONVERGENCE_ORDERS_METRICS,
    options={
        "metric": Annotated[Literal["error_low", "error_high"], Field(description="metric that is fitted")],
    },
)(convergence_orders)
