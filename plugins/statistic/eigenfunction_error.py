"""Errors of eigenfunctions, and what midpoints gain: theorem 3.2.1 and the end of section 3.2."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.spectrum.eigenfunction_error import eigenfunction_errors, midpoint_gain, values_below
from surfexp.statistics.statistic import Statistic

ERROR_METRICS = {
    "order_in_h": Metric("mean order of the errors in the edge length"),
    "least_order": Metric("least order"),
    "largest_order": Metric("largest order"),
    "constant": Metric("largest error over h^2 lambda", better="lower"),
    "constant_growth": Metric("constant of the upper half of the modes over that of the lower"),
    "exponent_of_value": Metric("exponent of the eigenvalue in a fit of the errors"),
    "edge_length": Metric("mean edge length", "unit of length"),
}


@register("statistic", "eigenfunction_error", metrics=ERROR_METRICS)
def eigenfunction_error_statistic(
    *,
    shape: Annotated[
        Literal["rectangle", "sphere"], Field(description="shape whose eigenfunctions are known")
    ] = "sphere",
    level: Annotated[int, Field(ge=2, le=7, description="finer mesh; edges of the coarser one are twice as long")] = 4,
    count: Annotated[int, Field(ge=4, le=400, description="eigenfunctions after the constant")] = 40,
) -> Statistic:
    """Order in h and constant of the bound C h^2 lambda (3.24) on two meshes of a sphere or a rectangle."""
    coarse, fine = (eigenfunction_errors(shape, level - k, count) for k in (1, 0))
    orders = np.log(coarse.errors / fine.errors) / np.log(coarse.edge_length / fine.edge_length)
    constants = fine.errors / (fine.edge_length**2 * fine.values)
    half = count // 2
    metrics = {
        "order_in_h": float(orders.mean()),
        "least_order": float(orders.min()),
        "largest_order": float(orders.max()),
        "constant": float(constants.max()),
        "constant_growth": float(constants[half:].max() / constants[:half].max()),
        "exponent_of_value": float(np.polyfit(np.log(fine.values), np.log(fine.errors), 1)[0]),
        "edge_length": fine.edge_length,
    }
    modes = np.arange(1.0, count + 1.0)
    columns = {"mode": modes, "value": fine.values, "error": fine.errors, "constant": constants}
    return Statistic(f"errors of eigenfunctions, {shape}", columns, metrics=metrics)


GAIN_METRICS = {
    "mean_gain": Metric("mean factor by which errors fall", better="higher"),
    "least_gain": Metric("least factor", better="higher"),
    "largest_gain": Metric("largest factor", better="higher"),
}


@register("statistic", "midpoint_gain", metrics=GAIN_METRICS)
def midpoint_gain_statistic(
    *,
    shape: Annotated[Literal["rectangle", "sphere"], Field(description="shape whose eigenvalues are known")] = "sphere",
    level: Annotated[int, Field(ge=1, le=6, description="mesh that is cut once")] = 3,
    count: Annotated[int, Field(ge=4, le=400, description="eigenvalues after 0")] = 24,
    project: Annotated[
        bool, Field(description="midpoints carried to the smooth surface; else left on the facets")
    ] = False,
) -> Statistic:
    """Factor by which the errors of eigenvalues fall when every triangle is cut into four at its midpoints."""
    gains = midpoint_gain(shape=shape, level=level, count=count, project=project)
    metrics = {"mean_gain": float(gains.mean()), "least_gain": float(gains.min()), "largest_gain": float(gains.max())}
    columns = {"mode": np.arange(1.0, count + 1.0), "gain": gains}
    where = "on the smooth surface" if project else "on the facets"
    return Statistic(f"gain by midpoints {where}, {shape}", columns, metrics=metrics)


BELOW_METRICS = {
    "below_exact": Metric("eigenvalues below the exact ones"),
}


@register("statistic", "values_below", metrics=BELOW_METRICS)
def values_below_statistic(
    *,
    level: Annotated[int, Field(ge=1, le=6, description="level of the icosphere")] = 4,
    count: Annotated[int, Field(ge=1, le=400, description="eigenvalues after 0")] = 24,
    circumscribed: Annotated[bool, Field(description="facets outside of the sphere; else inside")] = False,
) -> Statistic:
    """Number of eigenvalues of linear elements that lie under those of the sphere, which (3.25) excludes."""
    where = "outside" if circumscribed else "inside"
    below = float(values_below(level, count, circumscribed))
    return Statistic(f"values of facets {where} of the sphere", metrics={"below_exact": below})
