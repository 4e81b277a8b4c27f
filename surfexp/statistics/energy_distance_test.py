"""Permutation test of the energy distance of two groups."""

from __future__ import annotations

from itertools import combinations
from math import comb

import numpy as np

from surfexp.contract.arrays import Floats, Integers


def p_value(
    distances: Floats,
    first: Integers,
    second: Integers,
    permutations: int,
    rng: np.random.Generator,
    units: Integers | None = None,
) -> float:
    """Return the share of permutations, the true one counted in, whose energy distance is at least that of the groups.

    Parameters
    ----------
    distances : (n, n) float64
    first, second : int64 arrays
        Members of the groups.
    permutations : int
        Random ones; all splits are taken where they are no more.
    rng : numpy.random.Generator
    units : (n,) int64, optional
        Members of equal number stay together and in one group; default: each for itself.
    """
    together = np.concatenate([first, second])
    block = distances[np.ix_(together, together)]
    numbers = together if units is None else units[together]
    names, where = np.unique(numbers, return_inverse=True)
    true = np.isin(names, numbers[: len(first)])
    one = _splits(true, permutations, rng)[:, where]
    # with u = 1/m on one group and -1/n on the other the energy distance is -u^T D u
    sizes = one.sum(axis=1, keepdims=True)
    weights = np.where(one, 1.0 / sizes, -1.0 / (len(together) - sizes))
    energies = -np.einsum("pi,ij,pj->p", weights, block, weights, optimize=True)
    return float((energies >= energies[0] - 1e-12 * abs(energies[0])).mean())


def _splits(true: np.ndarray, permutations: int, rng: np.random.Generator) -> np.ndarray:
    """(p, u) splits of the units, the true one first: all others where they are few, else random ones."""
    count, size = len(true), int(true.sum())
    if comb(count, size) <= permutations + 1:
        splits = np.zeros((comb(count, size), count), bool)
        for row, members in zip(splits, combinations(range(count), size), strict=True):
            row[list(members)] = True
        return np.concatenate([true[None], splits[(splits != true).any(axis=1)]])
    return np.stack([true, *(true[rng.permutation(count)] for _ in range(permutations))])
