"""Nearest neighbours between two sets of points: trees in few dimensions, products of matrices in many, both exact."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from surfexp.contract.arrays import Floats, Integers

LARGEST_TREE_DIMENSION = 5
BLOCK = 256
DIRECT = 1e-9
SINGLE = 6e-8


def nearest(points: Floats, targets: Floats) -> tuple[Integers, Floats]:
    """Return for each point the row of the nearest target, the first of several, and the distance.

    In many dimensions products in single precision decide where their rounding cannot matter, double precision elsewhere.

    Parameters
    ----------
    points : (p, n) float64
    targets : (q, n) float64
        At least one.

    Returns
    -------
    (p,) int64, (p,) float64
    """
    if points.shape[1] <= LARGEST_TREE_DIMENSION:
        distances, rows = cKDTree(targets).query(points)
        return rows.astype(np.int64), distances
    rows = np.empty(len(points), np.int64)
    norms, own = (targets**2).sum(axis=1), (points**2).sum(axis=1)
    left = np.hstack([points, np.ones((len(points), 1))]).astype(np.float32)
    right = np.hstack([-2.0 * targets, norms[:, None]]).T.astype(np.float32)
    slack = (2.0 * rounding_error(points.shape[1], own, float(norms.max(initial=0.0)))).astype(np.float32)
    doubtful = np.zeros(len(points), bool)
    for start in range(0, len(points), BLOCK):
        some = slice(start, start + BLOCK)
        squares = left[some] @ right
        rows[some] = squares.argmin(axis=1)
        winners = np.arange(len(squares)), rows[some]
        least = squares[winners]
        squares[winners] = np.inf
        doubtful[some] = squares.min(axis=1) <= least + slack[some]
    again = np.flatnonzero(doubtful)
    for start in range(0, len(again), BLOCK):
        these = again[start : start + BLOCK]
        rows[these] = (points[these] @ (-2.0 * targets.T) + norms).argmin(axis=1)
    return rows, np.asarray(np.linalg.norm(points - targets[rows], axis=1))


def rounding_error(dimension: int, own: Floats, largest: float) -> Floats:
    """Return a bound of the error of |y|^2 - 2 x.y in single precision, for each |x|^2 and the largest |y|^2."""
    return (dimension + 4) * SINGLE * 2.0 * (own + largest)


def mutual_distances(source: Floats, target: Floats) -> tuple[Floats, Floats]:
    """Return the distance of each source row to the target set, and of each target row to the source set.

    One product of matrices serves both directions; distances that rounding would spoil are computed again by a tree.
    """
    if source.shape[1] <= LARGEST_TREE_DIMENSION:
        return cKDTree(target).query(source)[0], cKDTree(source).query(target)[0]
    forward, backward = np.empty(len(source)), np.full(len(target), np.inf)
    products, norms = -2.0 * target.T, (target**2).sum(axis=1)
    own = (source**2).sum(axis=1)
    for start in range(0, len(source), BLOCK):
        some = slice(start, start + BLOCK)
        squares = source[some] @ products
        squares += norms
        squares += own[some, None]
        forward[some] = squares.min(axis=1)
        np.minimum(backward, squares.min(axis=0), out=backward)
    floor = DIRECT * max(float(own.max()), float(norms.max()))
    results = []
    for squares, points, others in ((forward, source, target), (backward, target, source)):
        spoilt = squares < floor
        distances = np.sqrt(np.maximum(squares, 0.0))
        if spoilt.any():
            distances[spoilt] = cKDTree(others).query(points[spoilt])[0]
        results.append(distances)
    return results[0], results[1]
