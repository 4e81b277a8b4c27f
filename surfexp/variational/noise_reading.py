"""What a map says about its noise before it is denoised: level, correlation, outliers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.sparse import csr_array

from surfexp.contract.arrays import Floats, Integers
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.fitted_noise import TIED, FittedNoise, varies
from surfexp.variational.noise_correlation import correlation
from surfexp.variational.noise_level import FEWEST_PAIRS, NORMAL_MEDIAN, noise_level, pair_count
from surfexp.variational.noise_statistics import NoiseStatistics
from surfexp.variational.own_unit import odd_sign, own_unit

ROUNDING = 1e-12
PASSES = 4


def read_noise(
    operator: SurfaceOperator,
    values: Floats,
    second: Floats | None = None,
    seed: int = 0,
    level: float | None = None,
) -> FittedNoise:
    """Read the noise from a map, or from two measurements of it.

    A rounded map is dithered by half a step, for then the deviations are continuous again, and the variance of the
    dither is taken off; its noise counts as not less than that of rounding. In a map that is constant on a large part the
    level is that of the rest. Two measurements have the same map below them: half the square of their difference is
    that of the noise, and nothing of the map enters.

    Parameters
    ----------
    operator : SurfaceOperator
    values : (n,) float64
    second : (n,) float64, optional
        Another measurement of the same map, with noise of the same kind.
    seed : int
        Of the dither.
    level : float, optional
        Standard deviation, where it is known: that of white noise on a surface that is too small to be read.

    Raises
    ------
    ValueError
        If the surface has under 20 pairs of neighbouring triangles, and no level is known.
    """
    if level is not None and pair_count(operator) < FEWEST_PAIRS:
        return _white(level, len(values))
    own = own_unit(values)
    again = None if second is None else own.normalised(second)
    return _read(operator, own.normalised(values), again, seed).in_unit(own.unit)


def _read(operator: SurfaceOperator, values: Floats, second: Floats | None, seed: int) -> FittedNoise:
    """Read the noise of a map in its own unit."""
    noise_level(operator, values)
    statistics = NoiseStatistics(operator)
    plain = values if second is None else (values - second) / np.sqrt(2.0)
    deviations = statistics.deviations(plain)
    free = deviations > ROUNDING * np.abs(values).max(initial=0.0)
    tied = float(1.0 - free.mean())
    if not free.any():
        return replace(_white(0.0, len(values)), tied=tied, measurements=1 + (second is not None))
    step = _step(values, tied) if second is None else 0.0
    if step:
        # the negative map has the same noise
        plain = plain + odd_sign(plain) * step * (np.random.default_rng(seed).random(len(values)) - 0.5)
        free = np.ones(len(free), dtype=bool)
    read = _fitted(statistics, plain, free, second is not None)
    if step:
        variance = max(read.level**2 - step**2 / 12.0, step**2 / 12.0)
        read = read.with_level(float(np.sqrt(variance)))
    return replace(read, step=step, tied=tied, measurements=1 + (second is not None))


def _white(level: float, count: int) -> FittedNoise:
    """White noise of one level."""
    return FittedNoise(level, np.full(count, level), 1.0, 0.0, 1.0, 0.0, 0.0, np.empty(0, dtype=np.int64))


def without_outliers(operator: SurfaceOperator, values: Floats, places: Integers) -> Floats:
    """Return the map with each of these values replaced by the median of its neighbours that are none of them.

    Where all neighbours are, those that were replaced before it count.
    """
    ends = operator.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    ring = csr_array((np.ones(2 * len(ends)), np.concatenate([ends, ends[:, ::-1]]).T), shape=2 * (len(values),))
    filled, left = values.copy(), np.zeros(len(values), dtype=bool)
    left[places] = True
    while left.any():
        good = ~left
        for vertex in np.flatnonzero(left):
            near = ring.indices[ring.indptr[vertex] : ring.indptr[vertex + 1]]
            if good[near].any():
                filled[vertex] = np.median(filled[near[good[near]]])
                left[vertex] = False
        if np.array_equal(left, ~good):
            break
    return filled


def _fitted(statistics: NoiseStatistics, values: Floats, free: np.ndarray, noise_alone: bool) -> FittedNoise:
    """Level, outliers and correlation of values that are not tied where it counts."""
    outliers = np.empty(0, dtype=np.int64)
    for _ in range(PASSES):
        deviations = statistics.deviations(values)
        whole = float(np.median(deviations[free])) / NORMAL_MEDIAN
        levels = statistics.local_level(deviations, free)
        # outliers near one another hide each other until the first of them are replaced
        found_now = np.setdiff1d(statistics.outliers(values, np.maximum(whole, levels)), outliers)
        if not len(found_now):
            break
        outliers = np.union1d(outliers, found_now)
        values = without_outliers(statistics.operator, values, outliers)
        good = np.ones(len(values), dtype=bool)
        good[outliers] = False
        if not (kept_pairs := free & good[statistics.relations[0]].all(axis=1)).any():
            break
        free = kept_pairs
    seen = statistics.informative(free)
    seen = seen if seen.any() else np.ones(len(values), dtype=bool)
    spread = float(np.quantile(levels[seen], 0.9) / np.quantile(levels[seen], 0.1))
    rings = statistics.ring_medians(values, seen)
    growth = float(rings[2] / rings[1]) if rings[1] > 0 else np.inf
    varying = varies(spread, growth, noise_alone)
    levels = np.where(seen, levels, whole) if varying else np.full(len(values), whole)
    found = correlation(statistics, rings**2, noise_alone)
    if noise_alone:
        around = np.abs(values[seen] - np.median(values[seen]))
        levels = levels * float(np.median(around)) / NORMAL_MEDIAN / whole
    else:
        levels = levels / found.level_ratio
    width = found.width * statistics.operator.edge_length
    kept = np.delete(levels, outliers) if len(outliers) < len(levels) else levels
    level = float(np.sqrt((kept**2).mean())) if varying else float(levels[0])
    return FittedNoise(level, levels, spread, width, growth, 0.0, 0.0, outliers)


def _step(values: Floats, tied: float) -> float:
    """Of a rounded map: many pairs are tied, and most values that occur do so more than once, not zero alone."""
    if tied < TIED:
        return 0.0
    distinct, counts = np.unique(values, return_counts=True)
    if 2 * int((counts > 1).sum()) < len(distinct):
        return 0.0
    return float(np.median(np.diff(distinct)))
