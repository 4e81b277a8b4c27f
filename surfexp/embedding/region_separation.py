"""Whether regions of two surfaces can be told apart in an embedding: the rule for n of section 6.4.2."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from surfexp.contract.arrays import Floats, Integers


@dataclass(frozen=True)
class Separation:
    """Distances between centres of regions, in the unit of the points.

    Parameters
    ----------
    between : float
        Mean distance of a region's centre to the nearest centre of another region of the same surface.
    within : float
        Mean distance between the centres of one region on the two surfaces.
    found : float
        Share of regions whose own centre is the nearest one on the other surface.
    """

    between: float
    within: float
    found: float


def region_separation(
    points: Floats,
    weights: Floats,
    labels: Integers,
    other_points: Floats,
    other_weights: Floats,
    other_labels: Integers,
) -> Separation:
    """Compare regions of equal label on two surfaces; negative labels and those of one surface alone are left out.

    Parameters
    ----------
    points, other_points : (v, n), (w, n) float64
        The surfaces in one space.
    weights, other_weights : (v,), (w,) float64
        Share of the area of each vertex.
    labels, other_labels : (v,), (w,) int64

    Raises
    ------
    ValueError
        If the surfaces have fewer than two regions in common.
    """
    common = np.intersect1d(labels[labels >= 0], other_labels[other_labels >= 0])
    if len(common) < 2:
        raise ValueError(f"the surfaces have {len(common)} labelled regions in common, at least 2 are needed")
    first = _centres(points, weights, labels, common)
    second = _centres(other_points, other_weights, other_labels, common)
    among = np.linalg.norm(first[:, None] - first[None, :], axis=2)
    across = np.linalg.norm(first[:, None] - second[None, :], axis=2)
    np.fill_diagonal(among, np.inf)
    found = float((across.argmin(axis=1) == np.arange(len(common))).mean())
    return Separation(float(among.min(axis=1).mean()), float(np.diag(across).mean()), found)


def _centres(points: Floats, weights: Floats, labels: Integers, regions: Integers) -> Floats:
    rows = [np.average(points[labels == region], axis=0, weights=weights[labels == region]) for region in regions]
    return np.array(rows)
