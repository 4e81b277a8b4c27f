"""Closed genus-0 surfaces with sulci and gyri like a cortex, without self-intersection."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numba import njit

from surfexp.mesh.implicit_surface import mesh_implicit
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import Floats

SEMIAXES = np.array([0.85, 1.1, 0.95])
# depth and width of the sulci
FORMS = {"smooth": (0.10, 0.55), "folded": (0.34, 0.32)}
WAVE_COUNT, WAVE_NUMBER = 48, 10.0


@njit(cache=True, nogil=True)
def _radius_excess(points: Floats, waves: Floats, phases: Floats, depth: float, width: float) -> Floats:
    excess = np.empty(len(points))
    for i in range(len(points)):
        length = max(np.sqrt((points[i] ** 2).sum()), 1e-12)
        field = 0.0
        for k in range(len(phases)):
            product = waves[k, 0] * points[i, 0] + waves[k, 1] * points[i, 1] + waves[k, 2] * points[i, 2]
            field += np.cos(product / length + phases[k])
        field *= np.sqrt(2.0 / len(phases))
        excess[i] = length - 1.0 + depth * np.exp(-((field / width) ** 2))
    return excess


def cortex(form: Literal["smooth", "folded"] = "folded", count: int = 39994, seed: int = 0) -> Surface:
    """Ellipsoid with narrow sulci along the zero lines of a random field of one wavelength.

    The surface is the radial graph r(d) = 1 - depth * exp(-(g(d) / width)^2) over the directions d, stretched to the
    semiaxes 0.85, 1.1, 0.95, so it cannot intersect itself. "smooth" and "folded" share their sulci and stand for M1
    and M2 of table 2.2.

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

    box = SEMIAXES + 0.05
    mesh = mesh_implicit(implicit, (-box).tolist(), box.tolist(), min(6.0 / np.sqrt(count), 0.04), count)
    return Surface(mesh, name=f"{form} cortex-like surface")
