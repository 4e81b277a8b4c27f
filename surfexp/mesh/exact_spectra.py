"""Laplace-Beltrami spectra that are known in closed form."""

from __future__ import annotations

import numpy as np
from scipy.special import jn_zeros, jnp_zeros

from surfexp.contract.arrays import Floats


def sphere_spectrum(count: int, radius: float = 1.0) -> Floats:
    """Return the first eigenvalues l (l + 1) / R^2, 2 l + 1 times each."""
    degree = np.arange(int(np.sqrt(count)) + 2)
    return np.repeat(degree * (degree + 1.0), 2 * degree + 1)[:count] / radius**2


def rectangle_spectrum(count: int, width: float, height: float, boundary: str) -> Floats:
    """Return the first eigenvalues pi^2 (m^2 / a^2 + n^2 / b^2), from 0 (Neumann) or 1 (Dirichlet) on."""
    m = np.arange(0 if boundary == "neumann" else 1, count + 1)
    return np.sort((np.pi**2 * ((m[:, None] / width) ** 2 + (m[None, :] / height) ** 2)).ravel())[:count]


def disk_spectrum(count: int, radius: float, boundary: str) -> Floats:
    """Return the first squared zeros of the Bessel functions (Dirichlet) or their derivatives (Neumann)."""
    zeros = jn_zeros if boundary == "dirichlet" else jnp_zeros
    reach = int(2.5 * np.sqrt(count)) + 4
    squares = [np.repeat(zeros(order, reach) ** 2, 1 if order == 0 else 2) for order in range(reach)]
    squares += [np.zeros(1)] if boundary == "neumann" else []
    return np.sort(np.concatenate(squares))[:count] / radius**2


def lattice_spectrum(count: int, periods: Floats) -> Floats:
    """Return the first eigenvalues 4 pi^2 |w|^2 over the dual lattice of the plane modulo two periods.

    Parameters
    ----------
    count : int
    periods : (2, 2) float64
        One period a row.
    """
    dual = np.linalg.inv(periods).T
    # |w| <= r has at most (2 r / s)^2 integer pairs, s the least singular value: enough of them for `count` values
    shortest, longest = np.linalg.svd(dual, compute_uv=False)[::-1]
    reach = int(np.ceil(2.0 * (np.sqrt(count) + 2.0) * longest / shortest))
    m, n = np.meshgrid(*[np.arange(-reach, reach + 1)] * 2, indexing="ij")
    waves = np.stack([m.ravel(), n.ravel()], axis=1) @ dual
    return np.sort(4.0 * np.pi**2 * (waves**2).sum(axis=1))[:count]
