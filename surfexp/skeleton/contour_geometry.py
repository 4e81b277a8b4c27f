"""Length, middle and centroid of contours, and contours resampled by arc length."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.skeleton.level_contours import LevelContours


def contour_steps(contours: LevelContours, points: Floats) -> tuple[Floats, Integers]:
    """Vector from each point to the next one of its contour, and the index of that next one.

    The step from the last point of an open contour is zero; from that of a closed one it leads to the first.
    """
    following = np.arange(1, len(points) + 1)
    last = contours.starts[1:] - 1
    following[last] = np.where(contours.closed, contours.starts[:-1], last)
    return points[following] - points, following


def contour_lengths(contours: LevelContours, vertices: Floats) -> Floats:
    """(C,) lengths, in the unit of the surface: the width measure of section 5.6 where contours are open."""
    steps = contour_steps(contours, contours.interpolate(vertices))[0]
    return np.add.reduceat(np.linalg.norm(steps, axis=1), contours.starts[:-1]) if len(steps) else np.zeros(0)


def representatives(contours: LevelContours, vertices: Floats) -> tuple[Floats, Floats]:
    """(C, 3) position that stands for each contour, and (C,) lengths.

    It is the centroid by length of a closed contour and the point in the middle of the arc length of an open one.
    """
    points = contours.interpolate(vertices)
    steps, following = contour_steps(contours, points)
    sizes = np.linalg.norm(steps, axis=1)
    owner = np.repeat(np.arange(len(contours.level)), np.diff(contours.starts))
    lengths = np.bincount(owner, sizes, len(contours.level)).astype(np.float64)
    middles = 0.5 * (points + points[following])
    # a contour shrunk to a point weighs its points alike
    weights = np.where(lengths[owner] > 0, sizes, 1.0)
    total = np.bincount(owner, weights, len(contours.level))
    centroids = np.stack([np.bincount(owner, weights * x, len(total)) for x in middles.T], axis=1) / total[:, None]
    middle = _at_share(contours, points, steps, sizes, 0.5)
    return np.asarray(np.where(contours.closed[:, None], centroids, middle), dtype=np.float64), lengths


def resampled(contours: LevelContours, values: Floats, vertices: Floats, count: int) -> Floats:
    """(C, count, ...) values of a function, or positions, at equal steps of arc length along each contour.

    The first and last samples are the ends of an open contour; a closed one begins at its first point and does not repeat it.
    """
    points = contours.interpolate(vertices)
    steps, following = contour_steps(contours, points)
    sizes, samples = np.linalg.norm(steps, axis=1), contours.interpolate(values)
    shares = np.linspace(0.0, 1.0, count)
    changes = samples[following] - samples
    found = [_at_share(contours, samples, changes, sizes, share, wrap=count) for share in shares]
    return np.stack(found, axis=1)


def _at_share(
    contours: LevelContours, samples: Floats, changes: Floats, sizes: Floats, share: float, wrap: int = 0
) -> Floats:
    """Samples where each contour has run through a share of its length."""
    travelled = np.concatenate([[0.0], np.cumsum(sizes)])
    first, end = contours.starts[:-1], contours.starts[1:]
    shares = np.full(len(first), share)
    if wrap:
        shares[contours.closed] *= (wrap - 1) / wrap
    target = travelled[first] + shares * (travelled[end] - travelled[first])
    at = np.clip(np.searchsorted(travelled, target, side="right") - 1, first, end - 1)
    part = np.divide(target - travelled[at], sizes[at], out=np.zeros(len(at)), where=sizes[at] > 0)
    part = np.clip(part, 0.0, 1.0).reshape(-1, *[1] * (samples.ndim - 1))
    return samples[at] + part * changes[at]
