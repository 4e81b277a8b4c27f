"""What all null models do with the values of a map: check them, permute them, and bring them back by rank."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats

LARGEST_COUNT = 1_000_000


def checked_map(values: Floats, vertices: int, count: int) -> Floats:
    """Return a map as float64 after a look at it and at the number of nulls that are wanted.

    Parameters
    ----------
    values : (n,) float64
    vertices : int
        How many values there have to be.
    count : int
        How many nulls are wanted.

    Returns
    -------
    (n,) float64

    Raises
    ------
    ValueError
        If the map has another shape, is not finite, or the number is not in 1..1,000,000.
    """
    array = np.asarray(values, dtype=np.float64)
    if array.shape != (vertices,):
        raise ValueError(f"map has shape {array.shape}, expected ({vertices},): one value for each vertex")
    bad = int((~np.isfinite(array)).sum())
    if bad:
        raise ValueError(f"map has {bad} values of {vertices} that are not finite: cut the surface to its mask first")
    if not 1 <= count <= LARGEST_COUNT:
        raise ValueError(f"count is {count}, must be in 1..{LARGEST_COUNT}")
    return array


def permuted_values(values: Floats, count: int, random: np.random.Generator) -> Floats:
    """Return the values of a map in random orders: the null model that keeps nothing else.

    Parameters
    ----------
    values : (n,) float64
    count : int
    random : numpy.random.Generator

    Returns
    -------
    (n, count) float64
    """
    return np.stack([random.permutation(values) for _ in range(count)], axis=1)


def matched_to_values(nulls: Floats, values: Floats) -> Floats:
    """Return maps with the values of a map: the k-th smallest of each null becomes the k-th smallest of the map.

    Parameters
    ----------
    nulls : (n, r) float64
    values : (n,) float64

    Returns
    -------
    (n, r) float64
        Equal values of a null keep their order.
    """
    matched = np.empty_like(nulls)
    ascending = np.broadcast_to(np.sort(values)[:, None], nulls.shape)
    np.put_along_axis(matched, np.argsort(nulls, axis=0, kind="stable"), ascending, axis=0)
    return matched
