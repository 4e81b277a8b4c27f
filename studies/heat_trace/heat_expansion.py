"""The heat trace of a computed spectrum beside its expansions, published and right."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.heat_trace import (
    Condition,
    corner_constant,
    hear_geometry,
    heat_trace,
    heat_trace_expansion,
    smooth_constant,
)
from surfexp.statistics.statistic import Statistic

TIMES = 24
# in units of 1 / lambda_k: long enough for what lies beyond the last value not to matter, short enough for three terms
SMALL_TIMES = (12.0, 48.0)


def heat_expansion(surface: Surface, system: EigenSystem) -> Statistic:
    """Compare Z(t) with theorem 3.1.2 as published and as it should read, and hear the geometry.

    Returns
    -------
    Statistic
        Columns: time, trace, corrected, published, and the two relative errors. Metrics: corrected_error and published_error
        (mean over the times), and the area, boundary length and Euler characteristic (or constant term, on polygons) that
        are heard with those of the mesh.
    """
    mesh = surface.mesh
    condition: Condition = (
        "closed" if mesh.is_closed else ("dirichlet" if system.boundary == "dirichlet" else "neumann")
    )
    length = boundary_length(surface)
    corners = None if surface.shape is None else surface.shape.corners
    constant = smooth_constant(mesh.euler_characteristic) if corners is None else corner_constant(np.array(corners))
    shortest, longest = (factor / float(system.values[-1]) for factor in SMALL_TIMES)
    times = np.geomspace(shortest, longest, TIMES)
    trace = heat_trace(system.values, times, system.area)
    corrected = heat_trace_expansion(times, system.area, length, constant, condition)
    published = published_expansion(times, system.area, length, mesh.euler_characteristic)
    heard = hear_geometry(system.values, condition)
    columns = {"time": times, "trace": trace, "corrected": corrected, "published": published}
    columns |= {"error corrected": np.abs(corrected / trace - 1.0), "error published": np.abs(published / trace - 1.0)}
    metrics = {
        "corrected_error": float(columns["error corrected"].mean()),
        "published_error": float(columns["error published"].mean()),
        "area": system.area,
        "area_heard": heard.area,
        "area_ratio": heard.area / system.area,
        "constant": constant,
        "constant_heard": heard.constant,
        "constant_off": abs(heard.constant - constant),
        "boundary_length": length,
        "boundary_heard": heard.boundary_length,
        "complete": float(system.complete),
    }
    if length:
        metrics["boundary_ratio"] = heard.boundary_length / length
    return Statistic(f"heat trace of the {surface.name}, {condition}", columns, metrics=metrics)


def published_expansion(times: Floats, area: float, boundary_length: float, euler_characteristic: int) -> Floats:
    """Return (4 pi t)^-1 (c_0 + c_1 sqrt t + c_2 t), (3.9), with the published (3.10).

    c_0 = A; c_1 = -(sqrt pi / 2) L whatever the condition on the boundary; c_2 = 2 chi / 3, which lacks a factor pi.
    """
    sum_ = area - 0.5 * np.sqrt(np.pi) * boundary_length * np.sqrt(times) + 2.0 * euler_characteristic / 3.0 * times
    return sum_ / (4.0 * np.pi * times)


def boundary_length(surface: Surface) -> float:
    """Return the total length of the boundary loops."""
    vertices = surface.mesh.vertices
    return float(
        sum(
            np.linalg.norm(vertices[loop] - np.roll(vertices[loop], -1, axis=0), axis=1).sum()
            for loop in surface.mesh.boundary_loops
        )
    )
