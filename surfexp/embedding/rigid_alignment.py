"""A map between two surfaces in space: iterated closest points from the principal axes."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.embedding.nearest import nearest

# turns of the principal axes against one another that are rotations
TURNS = ((1.0, 1.0, 1.0), (1.0, -1.0, -1.0), (-1.0, 1.0, -1.0), (-1.0, -1.0, 1.0))


def rigid_map(
    source: Floats, target: Floats, source_weights: Floats, target_weights: Floats, iterations: int = 40
) -> tuple[Integers, float]:
    """Return the source vertex nearest to each target vertex after rotation, shift and scaling, and the mean misfit.

    Iterated closest points (Besl, McKay 1992) from the four rotations that bring principal axes onto one another, of
    which the best end is taken; both sets are centred and scaled to the same mean square first.

    Parameters
    ----------
    source, target : (s, 3), (t, 3) float64
        Vertices.
    source_weights, target_weights : (s,), (t,) float64
        Their areas.
    iterations : int
        At most, from each start; they stop when the map repeats.

    Returns
    -------
    (t,) int64, float
        The map, and the root mean square distance of target vertices to theirs, over the radius of gyration.

    Raises
    ------
    ValueError
        If iterations is below 1 or the points of a surface all coincide.
    """
    if iterations < 1:
        raise ValueError(f"iterations = {iterations}, take at least 1")
    shares = target_weights / target_weights.sum()
    (first, first_axes), (second, second_axes) = (
        _normed(points, weights) for points, weights in ((source, source_weights), (target, target_weights))
    )
    ends = [_closest(first, second, shares, first_axes * turn @ second_axes.T, iterations) for turn in TURNS]
    return min(ends, key=lambda end: end[1])


def _normed(points: Floats, weights: Floats) -> tuple[Floats, Floats]:
    """Points about their centre in units of their radius, and right-handed principal axes by columns."""
    shares = weights / weights.sum()
    centred = points - shares @ points
    radius = float(np.sqrt(shares @ (centred**2).sum(axis=1)))
    if not radius > 0.0:
        raise ValueError(f"{len(points)} points coincide, a surface is needed")
    axes = np.linalg.eigh((centred * shares[:, None]).T @ centred)[1]
    axes[:, 0] *= np.sign(np.linalg.det(axes))
    return centred / radius, axes


def _closest(
    source: Floats, target: Floats, shares: Floats, rotation: Floats, iterations: int
) -> tuple[Integers, float]:
    """Alternate nearest points and the best rotation, by which source points times it are compared with the target's."""
    rows, misfit = nearest(target, source @ rotation)
    for _ in range(iterations):
        left, _, right = np.linalg.svd((source[rows] * shares[:, None]).T @ target)
        left[:, -1] *= np.sign(np.linalg.det(left @ right))
        rotation = left @ right
        previous = rows
        rows, misfit = nearest(target, source @ rotation)
        if (rows == previous).all():
            break
    return rows, float(np.sqrt(shares @ misfit**2))
