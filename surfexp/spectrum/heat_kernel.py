"""The heat kernel of a surface from its eigenpairs: diffusion and pointwise signatures."""

from __future__ import annotations

import numpy as np
from scipy.sparse import sparray

from surfexp.contract.arrays import Floats
from surfexp.spectrum.eigensystem import EigenSystem


def heat_kernel(system: EigenSystem, time: float, sources: Floats) -> Floats:
    """Return K(t, x, y) (3.7) for all x and the given vertices y.

    Parameters
    ----------
    system : EigenSystem
    time : float
        In length^2, not negative.
    sources : (s,) int64
        Vertices y.

    Returns
    -------
    (n, s) float64
    """
    return (system.vectors * _decay(system, time)) @ system.vectors[sources].T


def diffuse(system: EigenSystem, mass: sparray, function: Floats, time: float) -> Floats:
    """Return u(t) of (3.6), int K(t, x, y) f(y) dy: what the eigenpairs see of `function`, diffused.

    Parameters
    ----------
    system : EigenSystem
    mass : (n, n) sparse array
        Of the eigenproblem.
    function : (n,) or (n, c) float64
    time : float
        0 projects onto the eigenfunctions.
    """
    coefficients = system.vectors.T @ (mass @ function)
    decay = _decay(system, time)
    return system.vectors @ (decay[:, None] * coefficients if coefficients.ndim == 2 else decay * coefficients)


def heat_kernel_signature(system: EigenSystem, times: Floats) -> Floats:
    """Return K(t, x, x) for each time, (n, s) (Sun, Ovsjanikov and Guibas 2009)."""
    return np.asarray(system.vectors**2 @ np.exp(-np.multiply.outer(system.values, times)))


def _decay(system: EigenSystem, time: float) -> Floats:
    if time < 0:
        raise ValueError(f"time = {time:g}, heat does not flow backwards: take 0 or more")
    return np.exp(-system.values * time)
