"""The variogram of maps on a surface: half the mean squared difference of two vertices by their distance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.smoothing.geodesic_gaussian import near_distances

PAIRS_OF_A_LAG = 800
# Gaussian weights whose quartiles lie a quarter of the bandwidth from the lag
QUARTILES = 2.68


@dataclass(frozen=True, eq=False)
class VariogramPairs:
    """Pairs of vertices and what each says about each lag.

    Parameters
    ----------
    first, second : (p,) int64
        Ends of the pairs.
    lags : (h,) float64
        Distances at which the variogram is estimated, in the unit of the mesh.
    weights : (h, p) float64
        Rows of sum 1.
    """

    first: Integers
    second: Integers
    lags: Floats
    weights: Floats

    def of(self, maps: Floats) -> Floats:
        """Return the variograms of maps.

        Parameters
        ----------
        maps : (n,) or (n, c) float64

        Returns
        -------
        (h,) or (h, c) float64
        """
        return np.asarray(self.weights @ (0.5 * (maps[self.first] - maps[self.second]) ** 2))


def variogram_pairs(
    mesh: TriangleMesh, *, reach: float, lags: int = 25, vertices: int = 1000, seed: int = 0
) -> VariogramPairs:
    """Draw pairs of vertices for variograms up to a distance.

    Pairs are drawn among a random sample of vertices, up to 800 for each interval between lags, so that short distances are
    as well known as long ones. A pair at distance u has the weight exp(-(2.68 (u - h) / b)^2 / 2) at the lag h, b three
    times the step of the lags.

    Parameters
    ----------
    mesh : TriangleMesh
    reach : float
        The largest lag, in the unit of the mesh.
    lags : int
        How many, h.
    vertices : int
        Size of the sample.
    seed : int

    Returns
    -------
    VariogramPairs

    Raises
    ------
    ValueError
        If there are fewer than 2 lags or vertices, or no pair is as near as the first lags.
    """
    if lags < 2 or vertices < 2:
        raise ValueError(f"lags is {lags} and vertices {vertices}, both must be 2 or more")
    random = np.random.default_rng(seed)
    n = len(mesh.vertices)
    sample = np.sort(random.choice(n, min(vertices, n), replace=False))
    distances = csr_array(near_distances(mesh, reach, sample)[:, sample]).tocoo()
    upper = distances.row < distances.col
    first, second, lengths = distances.row[upper], distances.col[upper], distances.data[upper]
    places = np.linspace(reach / lags, reach, lags)
    kept = _stratified(np.minimum((lengths * lags / reach).astype(np.int64), lags - 1), lags, random)
    first, second, lengths = first[kept], second[kept], lengths[kept]
    bandwidth = 3.0 * (places[1] - places[0])
    weights = np.exp(-0.5 * (QUARTILES * (lengths - places[:, None]) / bandwidth) ** 2)
    total = weights.sum(axis=1, keepdims=True)
    if not total.min() > 1.0:
        raise ValueError(
            f"lag {places[total.argmin()]:.3g} has pairs of weight {total.min():.2g}, 1 is needed: sample more than "
            f"{len(sample)} vertices or choose a longer reach"
        )
    return VariogramPairs(sample[first], sample[second], places, weights / total)


def _stratified(intervals: Integers, count: int, random: np.random.Generator) -> Integers:
    """Up to 800 entries of each interval, in their order."""
    drawn = [np.flatnonzero(intervals == k) for k in range(count)]
    kept = [pairs if len(pairs) <= PAIRS_OF_A_LAG else random.choice(pairs, PAIRS_OF_A_LAG, False) for pairs in drawn]
    return np.sort(np.concatenate(kept))
