"""What two phases of a noisy map are before their boundary is drawn: clipped map, first regions, weight of the length."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.smoothing.fitted_smoothing import fitted_smoothing
from surfexp.variational.fidelity import Progress

# of the product of edge, contrast and noise; fixed on phases with shares of .5, .1 and .02 and seven kinds of noise
OF_LENGTH = 2.0
STARTS = (0.5, 0.8, 0.95, 0.99, 0.2, 0.05, 0.01)
ROUNDS = 60


@dataclass(frozen=True, eq=False)
class NoisyPhases:
    """Two phases of a map as denoising shows them.

    Parameters
    ----------
    clipped : (n,) float64
        The map within the range of the denoised one.
    brighter : (n,) bool
        Two means of the denoised map.
    mu : float
        Weight of the data beside the length: 1 / (2 * edge * contrast * noise).
    least, largest : float
        The range.
    """

    clipped: Floats
    brighter: NDArray[np.bool_]
    mu: float
    least: float
    largest: float


def noisy_phases(
    operator: SurfaceOperator, values: Floats, threads: int = 1, progress: Progress | None = None
) -> NoisyPhases:
    """Denoise a map and divide it by two means.

    Parameters
    ----------
    operator : SurfaceOperator
        Consistent.
    values : (n,) float64
    threads, progress
        As in `fitted_smoothing`.

    Raises
    ------
    ValueError
        If the map has no noise, or is constant once it is denoised.
    """
    found = fitted_smoothing(operator, values, threads=threads, progress=progress)
    clean = found.mixture.values
    least, largest = float(clean.min()), float(clean.max())
    if not largest > least:
        raise ValueError(f"the denoised map is constant at {least:g}, two regions need two values")
    brighter = two_means(clean, operator.mass)
    contrast = float(np.median(clean[brighter]) - np.median(clean[~brighter]))
    mu = 1.0 / (OF_LENGTH * operator.edge_length * contrast * found.noise.level)
    return NoisyPhases(np.clip(values, least, largest), brighter, mu, least, largest)


def two_means(values: Floats, mass: Floats) -> NDArray[np.bool_]:
    """Return where values exceed the threshold of two means by mass: of several starts the least sum of squares.

    Parameters
    ----------
    values : (n,) float64
        Not constant.
    mass : (n,) float64
    """
    best, region = np.inf, values > values.min()
    for start in STARTS:
        threshold = float(np.quantile(values, start))
        for _ in range(ROUNDS):
            above = values > threshold
            if above.all() or not above.any():
                break
            means = [float(np.average(values[part], weights=mass[part])) for part in (above, ~above)]
            before, threshold = threshold, 0.5 * (means[0] + means[1])
            if threshold == before:
                break
        above = values > threshold
        if above.all() or not above.any():
            continue
        left = sum(
            float(mass[part] @ (values[part] - np.average(values[part], weights=mass[part])) ** 2)
            for part in (above, ~above)
        )
        if left < best:
            best, region = left, above
    return region
