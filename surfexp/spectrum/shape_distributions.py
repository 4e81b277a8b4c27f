"""Distributions of point signatures over a surface: descriptors of whole shapes that do not know their size."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.heat_kernel import heat_kernel_signature
from surfexp.spectrum.heat_trace import heat_trace
from surfexp.spectrum.pointwise_signatures import global_point_signature, wave_kernel_signature

LEVELS = np.array([0.1, 0.3, 0.5, 0.7, 0.9])
RELATIVE_TIMES = np.geomspace(0.004, 0.4, 12)
ENERGIES = 16
SAMPLES, BINS, FARTHEST = 400, 40, 1.5
GPS_MODES = 24


def weighted_quantiles(values: Floats, weights: Floats, levels: Floats = LEVELS) -> Floats:
    """Return (levels, c) quantiles of each column of (n, c) values on points of the given weights."""
    result = np.empty((len(levels), values.shape[1]))
    for c, column in enumerate(values.T):
        order = np.argsort(column, kind="stable")
        reached = np.cumsum(weights[order]) - 0.5 * weights[order]
        result[:, c] = np.interp(levels * weights.sum(), reached, column[order])
    return result


def scaled_heat_trace(system: EigenSystem, times: Floats = RELATIVE_TIMES) -> Floats:
    """Return ln Z(t) at times in units of area / (4 pi), with Weyl's tail."""
    return np.log(heat_trace(system.values, times * system.area / (4.0 * np.pi), system.area))


def heat_distribution(system: EigenSystem, vertex_areas: Floats) -> Floats:
    """Return quantiles over the surface of ln (A K(t, x, x)) at times in units of area / (4 pi)."""
    times = RELATIVE_TIMES[RELATIVE_TIMES > 0.02] * system.area / (4.0 * np.pi)
    signature = heat_kernel_signature(system, times)[: len(vertex_areas)]
    return weighted_quantiles(np.log(np.maximum(system.area * signature, 1e-12)), vertex_areas).ravel()


def wave_distribution(system: EigenSystem, vertex_areas: Floats) -> Floats:
    """Return quantiles over the surface of the wave kernel signature times the area."""
    signature = wave_kernel_signature(system, ENERGIES, 2.0)[: len(vertex_areas)]
    return weighted_quantiles(system.area * signature, vertex_areas).ravel()


def embedding_distances(system: EigenSystem, vertex_areas: Floats, seed: int = 0) -> Floats:
    """Return the histogram of distances between random points in the space of (6.4), its first 24 coordinates.

    Points are drawn by area; distances are in units of their root mean square (Rustamov 2007, one distribution).
    """
    points = global_point_signature(system)[: len(vertex_areas), :GPS_MODES]
    chosen = _draw(vertex_areas, seed)
    differences = points[chosen][:, None] - points[chosen][None, :]
    distances = np.sqrt(np.einsum("ijk,ijk->ij", differences, differences))[np.triu_indices(len(chosen), 1)]
    distances /= np.sqrt((distances**2).mean())
    counts, _ = np.histogram(np.minimum(distances, 2.0 * FARTHEST * (1 - 1e-12)), BINS, (0.0, 2.0 * FARTHEST))
    return np.asarray(counts / counts.sum())


def _draw(weights: Floats, seed: int) -> Integers:
    cumulative = np.cumsum(weights) / weights.sum()
    places = (np.arange(SAMPLES) + np.random.default_rng(seed).uniform(size=SAMPLES)) / SAMPLES
    return np.minimum(np.searchsorted(cumulative, places), len(weights) - 1).astype(np.int64)
