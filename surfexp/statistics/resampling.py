"""Chance and uncertainty of an accuracy: bootstrap over groups, permutations of classes."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Integers

BOOTSTRAPS = 2000
CENTRAL = (2.5, 97.5)


def bootstrap_interval(right: np.ndarray, owners: Integers, rng: np.random.Generator) -> tuple[float, float]:
    """Return the central 95 % of the accuracy over collections drawn by whole groups."""
    count = int(owners.max()) + 1
    hits, sizes = np.bincount(owners, right, count), np.bincount(owners, minlength=count)
    draws = rng.integers(count, size=(BOOTSTRAPS, count))
    low, high = np.percentile(hits[draws].sum(axis=1) / sizes[draws].sum(axis=1), CENTRAL)
    return float(low), float(high)


def exact_interval(hits: int, trials: int) -> tuple[float, float]:
    """Return the 95 % interval of Clopper and Pearson (1934) of a share that was found in `hits` of `trials`."""
    from scipy.stats import beta

    tail = (100.0 - (CENTRAL[1] - CENTRAL[0])) / 200.0
    low = float(beta.ppf(tail, hits, trials - hits + 1)) if hits else 0.0
    return low, float(beta.ppf(1.0 - tail, hits + 1, trials - hits)) if hits < trials else 1.0


def permuted(codes: Integers, owners: Integers, rng: np.random.Generator) -> Integers:
    """Return the classes permuted inside each group, or among all where every group has one class only."""
    several = any(len(np.unique(codes[owners == owner])) > 1 for owner in np.unique(owners))
    if not several:
        return np.asarray(rng.permutation(codes))
    result = codes.copy()
    for owner in np.unique(owners):
        here = np.flatnonzero(owners == owner)
        result[here] = rng.permutation(codes[here])
    return result
