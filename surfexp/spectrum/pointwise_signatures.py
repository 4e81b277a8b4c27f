"""Signatures of single points that isometries keep: wave kernel signature and global point signature."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.spectrum.eigensystem import EigenSystem


def wave_kernel_signature(system: EigenSystem, count: int = 100, width: float = 7.0) -> Floats:
    """Return the mean square of phi at each point in `count` logarithmic energy bands (Aubry, Schlickewei and Cremers 2011).

    Parameters
    ----------
    system : EigenSystem
    count : int
        Number of energies, evenly from ln lambda_1 to ln lambda_k.
    width : float
        Width of a band in steps of the energies.

    Returns
    -------
    (n, count) float64
    """
    values, vectors = _moving(system)
    energies = np.log(values)
    bands = np.linspace(energies[0], energies[-1], count)
    sigma = width * (bands[1] - bands[0])
    weights = np.exp(-((bands[None, :] - energies[:, None]) ** 2) / (2.0 * sigma**2))
    return np.asarray(vectors**2 @ (weights / weights.sum(axis=0)))


def global_point_signature(system: EigenSystem, power: float = 0.5) -> Floats:
    """Return phi_i(x) / lambda_i^power for each point, (n, k - c) (Rustamov 2007).

    With power 1/2, as published in (6.4), sum_i phi_i^2 / lambda_i diverges like the logarithm of the number of modes; 1 gives
    the biharmonic embedding, which converges.
    """
    values, vectors = _moving(system)
    return np.asarray(vectors / values**power)


def _moving(system: EigenSystem) -> tuple[Floats, Floats]:
    moving = system.values > 1e-6 * system.values[-1]
    return system.values[moving], system.vectors[:, moving]
