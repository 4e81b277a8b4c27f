"""How far the noise of a map is correlated, read from what the map does over rings of neighbours."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import nnls
from scipy.sparse.csgraph import breadth_first_order, connected_components

from surfexp.contract.arrays import Floats, Integers
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.noise_statistics import RINGS, SAMPLE, NoiseStatistics

# full widths in edges; what is wider cannot be told from a map
WIDTHS = (0.0, 0.75, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0)
DRAWS = 4
# the pairs of triangles reach less far than the first ring
DISTANCES = np.array([0.7, *range(1, RINGS + 1)])
SMOOTH, WITH_BORDERS = (2.0, 4.0), (1.0, 2.0, 4.0)
# by how much noise of some width must explain the rings better than white noise, and over what is left unexplained
LEAST_GAIN, LEAST_SHARE = 0.1, 1.5
# white noise grows by nothing from the first to the second ring, noise of a width of 1.5 edges by a quarter
LEAST_GROWTH = 1.2
# beyond it the map itself is rough
LARGEST_GROWTH = 1.6
WIDEST = 2.5
# what a map that is rough itself leaves unexplained beside white noise, noise that is smooth does not
LARGEST_REST = 0.085


@dataclass(frozen=True)
class Correlation:
    """Of noise.

    Parameters
    ----------
    width : float
        Full width at half maximum in edges of the heat flow that makes such noise of white noise; 0 for white noise.
    level_ratio : float
        The level as pairs of triangles show it over the deviation of the noise, 1 for white noise: what is smooth they see
        too little of, and the map adds to it.
    """

    width: float = 0.0
    level_ratio: float = 1.0


def correlation(statistics: NoiseStatistics, squares: Floats, noise_alone: bool = False) -> Correlation:
    """Read the width of the noise from the levels over pairs of triangles and over rings 1 to 4.

    The square of each is that of the noise, which saturates at its width, plus what the map adds, which grows with
    powers of the distance: 4 where it is smooth, 1 and 2 near borders. How noise of a given width grows on this mesh is
    found by drawing it. A width is taken if it explains the five levels much better than white noise does.

    Parameters
    ----------
    statistics : NoiseStatistics
    squares : (5,) float64
        Of the levels, by `NoiseStatistics.ring_medians`, of values without outliers.
    noise_alone : bool
        Whether there is no map below the noise: half the difference of two measurements.
    """
    if not squares.all() or squares[2] < LEAST_GROWTH**2 * squares[1]:
        return Correlation()
    if not noise_alone and squares[2] > LARGEST_GROWTH**2 * squares[1]:
        return Correlation()
    growth = growth_of_noise(statistics.operator)
    rests = np.array([_explained(column, squares, () if noise_alone else SMOOTH)[1] for column in growth])
    best = int(np.argmin(rests))
    gain = rests[0] - rests[best]
    if not noise_alone and (gain < max(LEAST_GAIN, LEAST_SHARE * rests[best]) or WIDTHS[best] > WIDEST):
        return Correlation()
    if not noise_alone:
        beside_borders = [_explained(column, squares, WITH_BORDERS)[1] for column in growth]
        best = int(np.argmin(beside_borders))
        if WIDTHS[best] > WIDEST or beside_borders[best] > LARGEST_REST:
            return Correlation()
    variance = _explained(growth[best], squares, () if noise_alone else WITH_BORDERS)[0]
    return Correlation(WIDTHS[best], float(np.sqrt(squares[0] / variance)))


def growth_of_noise(operator: SurfaceOperator) -> Floats:
    """Return (w, 5) squares of the five levels for noise of deviation 1 of each width, as drawn on the mesh.

    Of a mesh of more than 20,000 vertices a patch stands for all.
    """
    statistics = NoiseStatistics(patch(operator, SAMPLE))
    white = np.random.default_rng(0).standard_normal((statistics.operator.vertex_count, DRAWS))
    drawn = [statistics.smooth_noise(white, width) for width in WIDTHS]
    levels = [[statistics.ring_medians(np.ascontiguousarray(one)) for one in noise.T] for noise in drawn]
    return np.asarray((np.array(levels) ** 2).mean(axis=1))


def patch(operator: SurfaceOperator, count: int) -> SurfaceOperator:
    """Return the operator on the faces around one vertex of the largest component, of at most `count` vertices.

    The operator itself where it has no more.
    """
    if operator.vertex_count <= count:
        return operator
    ring = NoiseStatistics(operator).ring
    labels = connected_components(ring, directed=False)[1]
    start = int(np.argmax(labels == np.argmax(np.bincount(labels))))
    inside = np.zeros(operator.vertex_count, dtype=bool)
    inside[breadth_first_order(ring, start, return_predecessors=False)[:count]] = True
    faces = inside[operator.faces].all(axis=1)
    kept, corners = np.unique(operator.faces[faces], return_inverse=True)
    names: Integers = corners.reshape(-1, 3).astype(np.int64)
    return SurfaceOperator(names, operator.hat_gradients[faces], operator.areas[faces], len(kept))


def _explained(growth: Floats, squares: Floats, powers: tuple[float, ...]) -> tuple[float, float]:
    """The variance of noise that grows so, beside a map, and the length of what both leave of the relative squares."""
    columns = np.column_stack([growth, *(DISTANCES**power for power in powers)]) / squares[:, None]
    shares, rest = nnls(columns, np.ones(len(squares)))
    return float(shares[0]), float(rest)
