"""Nulls by smoothing of permuted maps until their variogram is that of the map (Burt et al. 2020)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.sparse import csr_array

from surfexp.contract.arrays import Floats, Integers
from surfexp.nulls.values_of_map import checked_map, matched_to_values, permuted_values
from surfexp.nulls.variogram import VariogramPairs

FRACTIONS = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9)
# so many columns of a map's nulls stay in the cache of a processor
COLUMNS_AT_ONCE = 32


class VariogramMatching:
    """Kernels of several widths on one surface, kept for many maps.

    Each null is a permuted map x, smoothed by the weights exp(-d / d_m) over the m nearest vertices, d_m the distance of the
    last, and mixed with noise, sqrt(b) x + sqrt(a) z. Of all m the one is taken whose variogram b g + a is nearest to that of
    the map; a and b are its least squares under a, b >= 0. (The authors take |a| and |b|; a negative part has no variance.)

    Parameters
    ----------
    neighbours : (n, k) int64
        Of `nearest_along_surface`.
    distances : (n, k) float64
    pairs : VariogramPairs
        At which the variogram is looked at; kernels are chosen by its vertices alone, which makes nulls of dense meshes cheap.
    fractions : sequence of float
        Of the k nearest vertices, a kernel each.

    Raises
    ------
    ValueError
        If there is no fraction, one is not in (0, 1] or holds fewer than 2 vertices, or the arrays do not belong together.
    """

    def __init__(
        self, neighbours: Integers, distances: Floats, pairs: VariogramPairs, fractions: Sequence[float] = FRACTIONS
    ) -> None:
        if neighbours.shape != distances.shape or neighbours.ndim != 2:
            raise ValueError(f"neighbours have shape {neighbours.shape} and distances {distances.shape}: both (n, k)")
        sizes = [round(fraction * neighbours.shape[1]) for fraction in fractions]
        if not sizes or min(sizes) < 2 or max(fractions) > 1.0:
            raise ValueError(
                f"fractions {tuple(fractions)} of {neighbours.shape[1]} neighbours are kernels of {sizes} vertices: fractions "
                "in (0, 1] of 2 or more are needed"
            )
        self.pairs = pairs
        self._count = len(neighbours)
        self._kernels = [_kernel(neighbours[:, :size], distances[:, :size]) for size in sizes]
        used = np.unique(np.concatenate([pairs.first, pairs.second]))
        self._sampled = [csr_array(kernel[used]) for kernel in self._kernels]
        place = np.zeros(self._count, dtype=np.int64)
        place[used] = np.arange(len(used))
        self._within = VariogramPairs(place[pairs.first], place[pairs.second], pairs.lags, pairs.weights)

    def nulls(self, values: Floats, count: int, *, match_values: bool = False, seed: int = 0) -> Floats:
        """Return nulls of a map, with its mean over the vertices.

        Parameters
        ----------
        values : (n,) float64
        count : int
            Number of nulls, r.
        match_values : bool
            Give each null the values of the map by rank.
        seed : int

        Returns
        -------
        (n, r) float64

        Raises
        ------
        ValueError
            If the map is not one finite value for each vertex.
        """
        array = checked_map(values, self._count, count)
        random = np.random.default_rng(seed)
        permuted = permuted_values(array, count, random)
        chosen, slopes, levels = self._choice(permuted, self.pairs.of(array))
        smoothed = np.empty_like(permuted)
        for k in np.unique(chosen):
            columns = np.flatnonzero(chosen == k)
            smoothed[:, columns] = _smoothed(self._kernels[k], permuted[:, columns])
        nulls = np.sqrt(slopes) * smoothed + np.sqrt(levels) * random.standard_normal(smoothed.shape)
        nulls += array.mean() - nulls.mean(axis=0)
        return matched_to_values(nulls, array) if match_values else nulls

    def _choice(self, permuted: Floats, wanted: Floats) -> tuple[Integers, Floats, Floats]:
        """Of each null the number of its kernel and the two weights of its mixture."""
        fits = []
        for kernel in self._sampled:
            found = self._within.of(_smoothed(kernel, permuted))
            fits.append(nonnegative_line(found, wanted))
        slopes, levels, errors = np.moveaxis(np.array(fits), 1, 0)
        chosen = errors.argmin(axis=0)
        every = np.arange(permuted.shape[1])
        return chosen, slopes[chosen, every], levels[chosen, every]


def nonnegative_line(found: Floats, wanted: Floats) -> tuple[Floats, Floats, Floats]:
    """Fit wanted = b found + a by least squares under a, b >= 0, for each column.

    Parameters
    ----------
    found : (h, r) float64
    wanted : (h,) float64

    Returns
    -------
    (r,) float64
        b.
    (r,) float64
        a.
    (r,) float64
        Sums of squared errors.
    """
    centred = found - found.mean(axis=0)
    slope = centred.T @ wanted / np.maximum((centred**2).sum(axis=0), np.finfo(float).tiny)
    level = wanted.mean() - slope * found.mean(axis=0)
    through_origin = found.T @ wanted / np.maximum((found**2).sum(axis=0), np.finfo(float).tiny)
    flat = slope < 0.0
    steep = ~flat & (level < 0.0)
    slope = np.where(flat, 0.0, np.where(steep, through_origin, slope))
    level = np.where(flat, wanted.mean(), np.where(steep, 0.0, level))
    return slope, level, ((slope * found + level - wanted[:, None]) ** 2).sum(axis=0)


def _kernel(neighbours: Integers, distances: Floats) -> csr_array:
    """Rows of sum 1, exponential in the distance over that of the last vertex."""
    n, size = neighbours.shape
    weights = np.exp(-distances / np.maximum(distances[:, -1:], np.finfo(float).tiny))
    weights /= weights.sum(axis=1, keepdims=True)
    starts = np.arange(0, n * size + 1, size, dtype=np.int32)
    return csr_array((weights.ravel(), neighbours.astype(np.int32).ravel(), starts), shape=(n, n))


def _smoothed(kernel: csr_array, maps: Floats) -> Floats:
    """Product of a kernel with many maps, some columns at a time."""
    blocks = [maps[:, start : start + COLUMNS_AT_ONCE] for start in range(0, maps.shape[1], COLUMNS_AT_ONCE)]
    return np.concatenate([kernel @ np.ascontiguousarray(block) for block in blocks], axis=1)
