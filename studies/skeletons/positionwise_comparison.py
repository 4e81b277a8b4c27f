"""Two groups of skeletons compared position by position, corrected for the number of positions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.skeleton.polyline import trunk
from surfexp.skeleton.skeleton import Skeleton


@dataclass(frozen=True, eq=False)
class PointwiseTest:
    """Welch's t and permutation p-values at each position.

    Parameters
    ----------
    statistic : (K,) float64
        Positive where the first group has the larger mean.
    uncorrected, corrected : (K,) float64
        Share of permutations with a |t| as large: at this position, or at any position (Westfall and Young 1993).
    """

    statistic: Floats
    uncorrected: Floats
    corrected: Floats


def pointwise_test(first: Floats, second: Floats, permutations: int = 1000, seed: int = 0) -> PointwiseTest:
    """Test at K positions at once whether two groups differ in their means.

    Parameters
    ----------
    first, second : (s, K), (r, K) float64
        One row a member, finite.
    permutations : int
        Random exchanges of membership; the observed one counts too, so p is at least 1 / (permutations + 1).

    Raises
    ------
    ValueError
        If a group has fewer than three members, or lengths differ.
    """
    if first.ndim != 2 or second.ndim != 2 or first.shape[1] != second.shape[1] or min(len(first), len(second)) < 3:
        raise ValueError(f"groups have shapes {first.shape} and {second.shape}; 3 members and equal lengths are needed")
    everyone, size = np.concatenate([first, second]), len(first)
    if not np.isfinite(everyone).all():
        raise ValueError(f"{int((~np.isfinite(everyone)).sum())} values are not finite")
    rng = np.random.default_rng(seed)
    observed = _welch(everyone, size)
    above, above_anywhere = np.ones(len(observed)), np.ones(len(observed))
    for _ in range(permutations):
        drawn = np.abs(_welch(everyone[rng.permutation(len(everyone))], size))
        above += drawn >= np.abs(observed) - 1e-12
        above_anywhere += drawn.max() >= np.abs(observed) - 1e-12
    return PointwiseTest(observed, above / (permutations + 1), above_anywhere / (permutations + 1))


def _welch(everyone: Floats, size: int) -> Floats:
    first, second = everyone[:size], everyone[size:]
    error = first.var(axis=0, ddof=1) / len(first) + second.var(axis=0, ddof=1) / len(second)
    difference = first.mean(axis=0) - second.mean(axis=0)
    return np.asarray(difference / np.sqrt(np.maximum(error, 1e-30)))


def widths_along(skeleton: Skeleton, count: int) -> Floats:
    """(count,) contour lengths at equal steps along the trunk, from the end of smaller x to the other."""
    nodes = trunk(skeleton)
    nodes = nodes[skeleton.level_index[nodes] >= 0]
    steps = np.linalg.norm(np.diff(skeleton.positions[nodes], axis=0), axis=1)
    travelled = np.concatenate([[0.0], np.cumsum(steps)])
    places = (np.arange(count) + 0.5) / count * travelled[-1]
    widths = np.interp(places, travelled, skeleton.lengths[nodes])
    return widths if skeleton.positions[nodes[0], 0] <= skeleton.positions[nodes[-1], 0] else widths[::-1]


def false_positive_share(
    group: Floats, halvings: int = 200, level: float = 0.05, seed: int = 0, permutations: int = 99
) -> float:
    """Share of random halvings of one group (s, K) in which some position is found to differ, corrected."""
    rng, half = np.random.default_rng(seed), len(group) // 2
    hits = 0
    for draw in range(halvings):
        order = rng.permutation(len(group))
        test = pointwise_test(group[order[:half]], group[order[half:]], permutations, seed + draw + 1)
        hits += int(test.corrected.min() <= level)
    return hits / halvings
