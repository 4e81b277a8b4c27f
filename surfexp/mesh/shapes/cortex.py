"""Closed genus-0 surfaces with sulci and gyri like a cortex, without self-intersection."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats
from surfexp.mesh.remeshing import remesh
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.shapes.fibonacci_sphere import fibonacci_sphere
from surfexp.mesh.surface import Surface

SEMIAXES = np.array([0.85, 1.1, 0.95])
# depth and half width of the sulci
FORMS = {"smooth": (0.12, 0.11), "folded": (0.31, 0.075)}
WAVE_COUNT, WAVE_NUMBER = 16, 11.0


@njit(cache=True, nogil=True)
def _radius_excess(points: Floats, waves: Floats, phases: Floats, depth: float, width: float) -> Floats:
    """Distance from the origin less r(direction), for each point."""
    excess = np.empty(len(points))
    for i in range(len(points)):
        length = max(np.sqrt(points[i, 0] ** 2 + points[i, 1] ** 2 + points[i, 2] ** 2), 1e-12)
        if length > 1.05 or length < 0.95 - depth:
            excess[i] = length - 1.0
            continue
        x, y, z = points[i, 0] / length, points[i, 1] / length, points[i, 2] / length
        field = gx = gy = gz = 0.0
        for k in range(len(phases)):
            angle = waves[k, 0] * x + waves[k, 1] * y + waves[k, 2] * z + phases[k]
            field += np.cos(angle)
            slope = -np.sin(angle)
            gx, gy, gz = gx + slope * waves[k, 0], gy + slope * waves[k, 1], gz + slope * waves[k, 2]
        radial = gx * x + gy * y + gz * z
        tangential = gx * gx + gy * gy + gz * gz - radial * radial
        # |g| / |grad g| is the distance from the zero line; the floor keeps it finite at saddles
        floor = 0.15 * len(phases) * WAVE_NUMBER**2 / 3.0
        excess[i] = length - 1.0 + depth / (1.0 + field * field / ((tangential + floor) * width * width))
    return excess


def cortex(form: Literal["smooth", "folded"] = "folded", count: int = 39994, seed: int = 0) -> Surface:
    """Ellipsoid, smooth or with narrow sulci along the zero lines of a random field of one wavelength; closed, genus 0.

    The surface is the radial graph r(d) = 1 - depth / (1 + (s(d) / width)^2) over the directions d, stretched to the
    semiaxes 0.85, 1.1, 0.95, so it cannot intersect itself; s = g / |grad g| is about the distance from a zero line.
    "smooth" and "folded" share their sulci and stand for M1 and M2 of table 2.2.

    Parameters
    ----------
    form : "smooth" or "folded"
    count : int
        Number of vertices, at least 10000, which is what the sulci need.
    seed : int
        Another field, another brain.

    Raises
    ------
    ValueError
        If the form is unknown or the count too small.
    """
    if form not in FORMS or count < 10000:
        raise ValueError(f"cortex has form = {form!r}, count = {count}; smooth or folded and at least 10000 are needed")
    random = np.random.default_rng(seed)
    directions = random.normal(size=(WAVE_COUNT, 3))
    waves = WAVE_NUMBER * directions / np.linalg.norm(directions, axis=1, keepdims=True)
    phases = random.uniform(0.0, 2.0 * np.pi, WAVE_COUNT)
    depth, width = FORMS[form]

    def implicit(points: Floats) -> Floats:
        return _radius_excess(points / SEMIAXES, waves, phases, depth, width)

    # a sphere pushed inward has the right topology however narrow the sulci are
    sphere = fibonacci_sphere(count).mesh
    radii = -_radius_excess(sphere.vertices, waves, phases, depth, width)
    mesh = remesh(sphere.vertices * (1.0 + radii[:, None]) * SEMIAXES, sphere.faces, implicit, count)
    return with_metrics(Surface(mesh, name=f"{form} cortex-like surface"))
