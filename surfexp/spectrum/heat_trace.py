"""The heat trace Z(t) = sum exp(-lambda t), its expansion for small t, and what can be heard in it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from surfexp.contract.arrays import Floats

Condition = Literal["closed", "dirichlet", "neumann"]
SIGNS = {"closed": 0.0, "dirichlet": -1.0, "neumann": 1.0}


@dataclass(frozen=True)
class HeardGeometry:
    """What a spectrum says of its surface.

    Parameters
    ----------
    area : float
    boundary_length : float
        0 for a closed surface.
    constant : float
        The constant term of Z: chi / 6 where the boundary is smooth or empty, `corner_constant` in its place for a flat polygon.
    """

    area: float
    boundary_length: float
    constant: float

    @property
    def euler_characteristic(self) -> float:
        """6 times the constant, for a smooth boundary or none."""
        return 6.0 * self.constant


def heat_trace(values: Floats, times: Floats, area: float | None = None) -> Floats:
    """Return Z(t) (3.8) of the given eigenvalues.

    Parameters
    ----------
    values : (k,) float64
    times : (s,) float64
        In length^2.
    area : float, optional
        Adds what Weyl's law says of the values beyond the last, A exp(-s t) / (4 pi t) from s = 4 pi k / A on; without it
        the sum is short where t is under about 5 / lambda_k.

    Raises
    ------
    ValueError
        If a time is not positive.
    """
    times = np.asarray(times, dtype=np.float64)
    if times.min() <= 0:
        raise ValueError(f"time {times.min():g} is not positive")
    trace = np.exp(-np.multiply.outer(times, values)).sum(axis=-1)
    if area is None:
        return trace
    beyond = max(float(values[-1]), 4.0 * np.pi * len(values) / area)
    return trace + area / (4.0 * np.pi * times) * np.exp(-beyond * times)


def heat_trace_expansion(
    times: Floats, area: float, boundary_length: float = 0.0, constant: float = 0.0, condition: Condition = "closed"
) -> Floats:
    """Return A / (4 pi t) -+ L / (8 sqrt(pi t)) + constant (McKean and Singer 1967), - Dirichlet, + Neumann.

    This is theorem 3.1.2 with c_0 = A, c_1 = -+ (sqrt pi / 2) L, c_2 = 4 pi constant; the published one has no pi in c_2 and
    the Dirichlet sign only.
    """
    _check(condition)
    times = np.asarray(times, dtype=np.float64)
    edge = SIGNS[condition] * boundary_length / (8.0 * np.sqrt(np.pi * times))
    return area / (4.0 * np.pi * times) + edge + constant


def smooth_constant(euler_characteristic: int) -> float:
    """Return chi / 6, the constant term where the boundary is smooth or empty: curvature and bending of it together."""
    return euler_characteristic / 6.0


def corner_constant(angles: Floats) -> float:
    """Return sum (pi^2 - theta^2) / (24 pi theta) over the corners of a flat polygon, its whole constant term."""
    angles = np.asarray(angles, dtype=np.float64)
    return float(((np.pi**2 - angles**2) / (24.0 * np.pi * angles)).sum())


def hear_geometry(values: Floats, condition: Condition = "closed", area: float | None = None) -> HeardGeometry:
    """Fit area, boundary length and constant to the heat trace of the lowest eigenvalues.

    Least squares of 4 pi t Z(t) by 1, sqrt t, t (and t^(3/2), t^2 for what follows), over the times from 16 / lambda_k to 20
    times that, where the values beyond the last do not matter.

    Parameters
    ----------
    values : (k,) float64
        At least 30.
    condition : "closed", "dirichlet" or "neumann"
        Closed surfaces have no odd terms.
    area : float, optional
        Where it is known, the others follow better.

    Raises
    ------
    ValueError
        If there are fewer than 30 values or the condition is unknown.
    """
    _check(condition)
    if len(values) < 30:
        raise ValueError(f"{len(values)} eigenvalues are too few to hear the geometry, at least 30 are needed")
    times = np.geomspace(16.0 / values[-1], 320.0 / values[-1], 60)
    scaled = 4.0 * np.pi * times * heat_trace(values, times)
    powers = np.array([0.0, 1.0, 2.0, 3.0]) if condition == "closed" else np.array([0.0, 0.5, 1.0, 1.5, 2.0])
    if area is not None:
        scaled, powers = scaled - area, powers[1:]
    columns = times[:, None] ** powers
    sizes = columns.max(axis=0)
    found = dict(zip(powers, np.linalg.lstsq(columns / sizes, scaled, rcond=None)[0] / sizes, strict=True))
    length = 0.0 if condition == "closed" else float(SIGNS[condition] * 2.0 / np.sqrt(np.pi) * found[0.5])
    heard = float(found[0.0]) if area is None else area
    return HeardGeometry(heard, length, float(found[1.0]) / (4.0 * np.pi))


def _check(condition: str) -> None:
    if condition not in SIGNS:
        raise ValueError(f"condition {condition!r} is unknown, choose closed, dirichlet or neumann")
