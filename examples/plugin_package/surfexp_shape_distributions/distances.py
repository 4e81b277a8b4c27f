"""Distances through space between random pairs of points of a surface."""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from surfexp_shape_distributions.sampling import point_in_triangle


def distance_quantiles(
    vertices: NDArray[np.float64], faces: NDArray[np.int64], count: int, pairs: int = 100_000, seed: int = 0
) -> NDArray[np.float64]:
    """Return quantiles of the distance between two points that are uniform on a surface, the shape distribution D2.

    Between two points of a unit sphere the distance r has density r / 2 on [0, 2], and its q-quantile is 2 sqrt(q).

    Parameters
    ----------
    vertices, faces : (n, 3) float64, (m, 3) int64
    count : int
        Number of quantiles, at (k + 1/2) / count.
    pairs : int
        Number of random pairs; a quantile has an error of the order pairs^(-1/2).
    seed : int

    Returns
    -------
    (count,) float64
        Ascending, in the unit of the vertices.
    """
    corners = vertices[faces]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    generator = np.random.default_rng(seed)
    chosen = generator.choice(len(faces), (pairs, 2), p=areas / areas.sum())
    distances = _distances(np.ascontiguousarray(corners), chosen, generator.random((pairs, 4)))
    return np.asarray(np.quantile(distances, (np.arange(count) + 0.5) / count))


@njit(cache=True)
def _distances(
    corners: NDArray[np.float64], chosen: NDArray[np.int64], uniform: NDArray[np.float64]
) -> NDArray[np.float64]:
    distances = np.empty(len(chosen))
    for i in range(len(chosen)):
        first = point_in_triangle(corners[chosen[i, 0]], uniform[i, 0], uniform[i, 1])
        second = point_in_triangle(corners[chosen[i, 1]], uniform[i, 2], uniform[i, 3])
        distances[i] = np.sqrt(((first - second) ** 2).sum())
    return distances
