"""The bottleneck distance of two persistence diagrams, exactly, and perfect matchings."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import maximum_bipartite_matching

from surfexp.contract.arrays import Floats, Integers


def bottleneck_distance(first: Floats, second: Floats) -> float:
    """Return the least e such that points are matched one to one within e, or lie within e of the diagonal.

    Parameters
    ----------
    first : (p, 2) float64
    second : (q, 2) float64

    Returns
    -------
    float
        In the maximum norm.
    """
    p, q = len(first), len(second)
    if p + q == 0:
        return 0.0
    costs = np.zeros((p + q, q + p))
    costs[:p, :q] = np.abs(first[:, None] - second[None]).max(axis=2, initial=0.0)
    # each point may leave to the diagonal, to which all copies of it are alike
    costs[:p, q:] = np.abs(first[:, 1] - first[:, 0])[:, None] / 2
    costs[p:, :q] = np.abs(second[:, 1] - second[:, 0])[None] / 2
    return least(np.unique(costs), lambda cost: has_perfect_matching(costs <= cost))


def has_perfect_matching(allowed: NDArray[np.bool_]) -> bool:
    """Whether rows and columns of a square matrix can be paired by entries that are true."""
    return bool(allowed.all()) if len(allowed) < 2 else bool((perfect_matching(allowed) >= 0).all())


def perfect_matching(allowed: NDArray[np.bool_]) -> Integers:
    """Return for each row of a square matrix the column it is paired with by an entry that is true, or -1."""
    return np.asarray(maximum_bipartite_matching(csr_array(allowed.astype(np.int8)), "column"), dtype=np.int64)


def least(candidates: Floats, possible: Callable[[float], bool]) -> float:
    """Return the least candidate that is possible, where the largest is and all above a possible one are.

    Parameters
    ----------
    candidates : (k,) float64
        Increasing.
    possible : callable

    Returns
    -------
    float
    """
    low, high = 0, len(candidates) - 1
    while low < high:
        middle = (low + high) // 2
        low, high = (low, middle) if possible(float(candidates[middle])) else (middle + 1, high)
    return float(candidates[high])
