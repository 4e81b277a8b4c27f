"""Nodal domains of a torus of revolution, exact by separation, against the filter that was set on the rectangle."""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigh

from surfexp.mesh.shapes.torus import torus
from surfexp.operators.fem import fem
from surfexp.spectrum.nodal_signature import counted_domains
from surfexp.spectrum.surface_spectrum import graph_of, surface_spectrum

POINTS = 300


def separated_modes(major: float, minor: float, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Eigenvalues and nodal numbers of the modes f(v) cos(m u): 2 m sectors times the zones of f, by Sturm's theorem."""
    step = 2.0 * np.pi / POINTS
    here = np.arange(POINTS) * step
    rho, between = major + minor * np.cos(here), major + minor * np.cos(here + step / 2)
    after = np.roll(np.eye(POINTS), 1, axis=1)
    slope = (after - np.eye(POINTS)) / step
    stiffness, mass = slope.T @ np.diag(between / minor) @ slope, minor * rho
    values, counts = [], []
    for m in range(16):
        found = eigh(stiffness + np.diag(m**2 * minor / rho), np.diag(mass), eigvals_only=True, subset_by_index=(0, 15))
        for j, value in enumerate(found):
            zones = 2 * ((j + 1) // 2)
            number = max(1, zones) * max(1, 2 * m)
            values += [value] * (2 if m else 1)
            counts += [number] * (2 if m else 1)
    order = np.argsort(values, kind="stable")[:count]
    return np.array(values)[order], np.array(counts)[order]


def test_filtered_counts_of_the_torus_are_exact() -> None:
    surface = torus(72, 28, 1.0, 0.4)
    operator = fem(surface.mesh)
    system = surface_spectrum(surface, operator, 60, order=2, curved=True)
    values, exact = separated_modes(1.0, 0.4, 60)
    assert np.abs(system.values - values).max() < 2e-3 * values[-1]
    graph = graph_of(operator, system)
    filtered, raw = counted_domains(system, graph, "filtered"), counted_domains(system, graph, "raw")
    assert (filtered == exact).sum() >= 58
    assert (filtered == exact)[:20].all()
    assert (raw == exact).sum() < (filtered == exact).sum()
