"""Nulls by random rotation of a map's mode coefficients (Koussis et al. 2025)."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Literal

import numpy as np
from scipy.sparse import csr_array

from surfexp.contract.arrays import Floats, Integers
from surfexp.nulls.values_of_map import checked_map, matched_to_values, permuted_values

Rest = Literal["drop", "permute"]
ORTHONORMAL = 1e-6


def eigenstrapped(
    modes: Floats,
    mass: csr_array,
    values: Floats,
    count: int,
    *,
    rest: Rest = "drop",
    match_values: bool = False,
    seed: int | Sequence[int] = 0,
) -> Floats:
    """Return nulls of a map that have its power in each group of modes.

    Modes are grouped as on a sphere, 1, 3, 5, ... at a time, and the coefficients c_l = V_l^T B f of each group are turned
    by a random rotation. The image of one vector under a Haar rotation is uniform on the sphere of its length, so that is
    drawn in place of the rotation. The constant mode is kept, and with it the mean of the map by area;
    a residual that is permuted moves it a little.

    Parameters
    ----------
    modes : (n, k) float64
        B-orthonormal, by increasing eigenvalue, the constant one first. What is left over at the end makes a group of its
        own.
    mass : (n, n) csr_array
        B.
    values : (n,) float64
    count : int
        Number of nulls, r.
    rest : {"drop", "permute"}
        What becomes of f - V V^T B f: left out, or added to each null with its values in a random order.
    match_values : bool
        Give each null the values of the map by rank; power and mean are kept no longer.
    seed : int or sequence of int

    Returns
    -------
    (n, r) float64

    Raises
    ------
    ValueError
        If the modes are not orthonormal, the first is not constant, `rest` is unknown, or the map is not one finite value
        for each vertex.

    References
    ----------
    Koussis, Pang, Phogat, Jeganathan, Paton, Fornito, Robinson, Misic, Breakspear: Generation of surrogate brain maps
    preserving spatial autocorrelation through random rotation of geometric eigenmodes (2025).
    """
    array = checked_map(values, len(modes), count)
    _check_modes(modes, mass)
    if rest not in ("drop", "permute"):
        raise ValueError(f"rest is {rest!r}, choose drop or permute")
    random = np.random.default_rng(seed)
    coefficients = modes.T @ (mass @ array)
    nulls = modes @ rotated_coefficients(coefficients, count, random)
    if rest == "permute":
        nulls += permuted_values(array - modes @ coefficients, count, random)
    return matched_to_values(nulls, array) if match_values else nulls


def rotated_coefficients(coefficients: Floats, count: int, random: np.random.Generator) -> Floats:
    """Return coefficients after random rotations of each group, the constant mode as it is.

    Parameters
    ----------
    coefficients : (k,) float64
    count : int
    random : numpy.random.Generator

    Returns
    -------
    (k, count) float64
    """
    turned = random.standard_normal((len(coefficients), count))
    edges = group_edges(len(coefficients))
    turned[0] = coefficients[0]
    for start, stop in pairwise(edges[1:]):
        block = turned[start:stop]
        block *= np.linalg.norm(coefficients[start:stop]) / np.linalg.norm(block, axis=0)
    return turned


def group_edges(count: int) -> Integers:
    """Return where groups of 1, 3, 5, ... modes begin, and the end of the last, which may be shorter.

    Parameters
    ----------
    count : int

    Returns
    -------
    (g + 1,) int64
        0, 1, 4, 9, ..., count.
    """
    degrees = np.arange(int(np.ceil(np.sqrt(count))), dtype=np.int64)
    return np.append(degrees**2, count)


def group_powers(modes: Floats, mass: csr_array, maps: Floats) -> Floats:
    """Return the squared length of the coefficients of maps in each group of modes.

    Parameters
    ----------
    modes : (n, k) float64
    mass : (n, n) csr_array
    maps : (n, c) float64

    Returns
    -------
    (g, c) float64
    """
    squares = (modes.T @ (mass @ maps)) ** 2
    return np.asarray(np.add.reduceat(squares, group_edges(modes.shape[1])[:-1], axis=0))


def _check_modes(modes: Floats, mass: csr_array) -> None:
    """Raise ValueError where the modes are no basis to rotate in."""
    if modes.ndim != 2 or not 1 <= modes.shape[1] <= len(modes) or mass.shape != (len(modes), len(modes)):
        raise ValueError(
            f"modes have shape {modes.shape} and the mass matrix {mass.shape}: (n, k) with k in 1..n and (n, n) are needed"
        )
    # V^T B V of one random vector, for all of it costs more than many nulls
    probe = np.random.default_rng(0).standard_normal(modes.shape[1])
    error = float(np.abs(modes.T @ (mass @ (modes @ probe)) - probe).max() / np.abs(probe).max())
    if not error <= ORTHONORMAL:
        raise ValueError(
            f"modes are orthonormal to {error:.1e}, must be to {ORTHONORMAL:g} in the mass matrix that is given"
        )
    first = modes[:, 0]
    if np.ptp(first) > ORTHONORMAL * np.abs(first).max():
        raise ValueError(
            f"the first mode varies by {np.ptp(first):.1e}, it must be constant: is the surface connected?"
        )
