"""Eigenfunctions of the torus of revolution by separation: their eigenvalues and exact nodal counts."""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigh

from surfexp.contract.arrays import Floats

# waves around the tube beyond those of the last mode, for spectral accuracy of the modes themselves
MORE_WAVES = 24


def torus_modes(count: int, major_radius: float = 1.0, minor_radius: float = 0.4) -> tuple[Floats, Floats]:
    """Return the first eigenvalues of the torus and the numbers of nodal domains of its separated eigenfunctions.

    With u around the axis, v around the tube and rho = R + r cos v an eigenfunction is cos(k u) g(v) or sin(k u) g(v),
    where g is even or odd in v and solves -(rho g')' / r^2 + k^2 g / rho = lambda rho g. The j-th even and the j-th odd
    one have 2 j zeros around the tube (Sturm), so that there are max(2 j, 1) max(2 k, 1) domains. The eigenvalues are
    found by Galerkin's method in cosines and sines.

    Even and odd functions of equal k and j have eigenvalues that become equal very fast as j grows. A mesh without the
    mirror symmetry mixes them into spirals cos(k u + j v) of 2 gcd(k, j) domains.

    Parameters
    ----------
    count : int
        At least 1; the constant one is the first.
    major_radius, minor_radius : float
        0 < r < R.

    Returns
    -------
    values : (count,) float64
        Increasing, in 1 / length^2.
    counts : (count,) float64

    Raises
    ------
    ValueError
        If the count or the radii are unfit.
    """
    if count < 1 or not 0.0 < minor_radius < major_radius:
        raise ValueError(f"count {count}, radii {major_radius}, {minor_radius}: count >= 1 and 0 < r < R are needed")
    area = 4.0 * np.pi**2 * major_radius * minor_radius
    # Weyl's law for the count, with a margin
    largest = 4.0 * np.pi * count / area * 1.2 + 20.0 / minor_radius**2
    waves = int(minor_radius * np.sqrt(largest * (1.0 + minor_radius / major_radius))) + MORE_WAVES
    values, counts = [], []
    for k in range(int((major_radius + minor_radius) * np.sqrt(largest)) + 2):
        for odd in (0, 1):
            found = _around_the_tube(k, waves, bool(odd), major_radius, minor_radius)
            domains = np.maximum(2.0 * np.arange(odd, odd + len(found)), 1.0) * max(2 * k, 1)
            kept = found <= largest
            times = 2 if k else 1
            values.append(np.repeat(found[kept], times))
            counts.append(np.repeat(domains[kept], times))
    every = np.concatenate(values)
    order = np.argsort(every, kind="stable")[:count]
    return every[order], np.concatenate(counts)[order]


def _around_the_tube(k: int, waves: int, odd: bool, major_radius: float, minor_radius: float) -> Floats:
    """Eigenvalues of -(rho g')' / r^2 + k^2 g / rho = lambda rho g over odd or even g, increasing."""
    points = 4 * (waves + MORE_WAVES)
    v = 2.0 * np.pi * np.arange(points) / points
    rho = major_radius + minor_radius * np.cos(v)
    j = np.arange(int(odd), waves + int(odd))[:, None]
    g, slope = (np.sin(j * v), j * np.cos(j * v)) if odd else (np.cos(j * v), -j * np.sin(j * v))
    stiffness = (slope * rho) @ slope.T / minor_radius**2 + k**2 * (g / rho) @ g.T
    return np.maximum(eigh(stiffness, (g * rho) @ g.T, eigvals_only=True), 0.0)
