"""Errors of eigenfunctions, and what midpoints gain: theorem 3.2.1 and the end of section 3.2."""

from typing import Literal

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.spectrum.eigenfunction_error import eigenfunction_errors, midpoint_gain, values_below
from surfexp.statistics.statistic import Statistic


class EigenfunctionError(Options):
    """The shape and its meshes."""

    shape: Literal["rectangle", "sphere"] = Field("sphere", description="shape whose eigenfunctions are known")
    level: int = Field(4, ge=2, le=7, description="finer mesh; edges of the coarser one are twice as long")
    count: int = Field(40, ge=4, le=400, description="eigenfunctions after the constant")


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
def eigenfunction_error_statistic(options: EigenfunctionError) -> Statistic:
    """Order in h and constant of the bound C h^2 lambda (3.24) on two meshes of a sphere or a rectangle."""
    coarse, fine = (eigenfunction_errors(options.shape, options.level - k, options.count) for k in (1, 0))
    orders = np.log(coarse.errors / fine.errors) / np.log(coarse.edge_length / fine.edge_length)
    constants = fine.errors / (fine.edge_length**2 * fine.values)
    half = options.count // 2
    metrics = {
        "order_in_h": float(orders.mean()),
        "least_order": float(orders.min()),
        "largest_order": float(orders.max()),
        "constant": float(constants.max()),
        "constant_growth": float(constants[half:].max() / constants[:half].max()),
        "exponent_of_value": float(np.polyfit(np.log(fine.values), np.log(fine.errors), 1)[0]),
        "edge_length": fine.edge_length,
    }
    modes = np.arange(1.0, options.count + 1.0)
    columns = {"mode": modes, "value": fine.values, "error": fine.errors, "constant": constants}
    return Statistic(f"errors of eigenfunctions, {options.shape}", columns, metrics=metrics)


class MidpointGain(Options):
    """The shape, its mesh, and where the midpoints go."""

    shape: Literal["rectangle", "sphere"] = Field("sphere", description="shape whose eigenvalues are known")
    level: int = Field(3, ge=1, le=6, description="mesh that is cut once")
    count: int = Field(24, ge=4, le=400, description="eigenvalues after 0")
    project: bool = Field(False, description="midpoints carried to the smooth surface; else left on the facets")


GAIN_METRICS = {
    "mean_gain": Metric("mean factor by which errors fall", better="higher"),
    "least_gain": Metric("least factor", better="higher"),
    "largest_gain": Metric("largest factor", better="higher"),
}


@register("statistic", "midpoint_gain", metrics=GAIN_METRICS)
def midpoint_gain_statistic(options: MidpointGain) -> Statistic:
    """Factor by which the errors of eigenvalues fall when every triangle is cut into four at its midpoints."""
    gains = midpoint_gain(**dict(options))
    metrics = {"mean_gain": float(gains.mean()), "least_gain": float(gains.min()), "largest_gain": float(gains.max())}
    columns = {"mode": np.arange(1.0, options.count + 1.0), "gain": gains}
    where = "on the smooth surface" if options.project else "on the facets"
    return Statistic(f"gain by midpoints {where}, {options.shape}", columns, metrics=metrics)


class ValuesBelow(Options):
    """Where the facets lie."""

    level: int = Field(4, ge=1, le=6, description="level of the icosphere")
    count: int = Field(24, ge=1, le=400, description="eigenvalues after 0")
    circumscribed: bool = Field(False, description="facets outside of the sphere; else inside")


BELOW_METRICS = {
    "below_exact": Metric("eigenvalues below the exact ones"),
}


@register("statistic", "values_below", metrics=BELOW_METRICS)
def values_below_statistic(options: ValuesBelow) -> Statistic:
    """Number of eigenvalues of linear elements that lie under those of the sphere, which (3.25) excludes."""
    where = "outside" if options.circumscribed else "inside"
    below = float(values_below(options.level, options.count, options.circumscribed))
    return Statistic(f"values of facets {where} of the sphere", metrics={"below_exact": below})
