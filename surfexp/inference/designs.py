"""Designs of common tests: a mean, two groups, pairs, each with covariates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from surfexp.contract.arrays import Floats, Integers
from surfexp.inference.rearrangements import CONSTANT
from surfexp.mesh.given_arrays import real_array

# how tables write that nothing is known: of one subject it would be a group, and of several a family
UNKNOWN = frozenset(["", "n/a", "na", "nan", "<na>", "nat"])


@dataclass(frozen=True, eq=False)
class Design:
    """A linear model of maps and the contrast that is tested.

    Parameters
    ----------
    matrix : (s, p) float64
    contrast : (p,) float64
    words : str
        What is tested.
    """

    matrix: Floats
    contrast: Floats
    words: str


def tested(
    data: Floats,
    design: ArrayLike | None,
    contrast: ArrayLike | None,
    groups: ArrayLike | None,
    pairs: ArrayLike | None,
    covariates: ArrayLike | None,
) -> tuple[Floats, Design]:
    """Return what is fitted, the data or the differences of pairs, and the design.

    Parameters
    ----------
    data : (s, n) float64
    design : (s, p) array_like, optional
    contrast : (p,) array_like, optional
    groups, pairs : (s,) array_like, optional
    covariates : (s,) or (s, q) array_like, optional

    Returns
    -------
    (s, n) or (s / 2, n) float64
    Design

    Raises
    ------
    ValueError
        If they do not go together, or a length differs.
    """
    if design is None:
        if contrast is not None:
            raise ValueError("a contrast is given without a design: give both, or groups")
        if pairs is None:
            return data, mean_or_groups(len(data), groups, covariates)
        if groups is None or covariates is not None:
            raise ValueError("pairs need groups and take no covariates: give groups, or a design with a column a pair")
        differences, words = differences_of_pairs(data, groups, pairs)
        mean = mean_or_groups(len(differences), None, None)
        return differences, Design(mean.matrix, mean.contrast, words)
    beside = {"groups": groups, "pairs": pairs, "covariates": covariates}
    if twice := [name for name, value in beside.items() if value is not None]:
        raise ValueError(f"a design and {twice[0]} are given: give one of them")
    matrix = finite_rows(design, len(data), "rows of the design")
    if contrast is None and matrix.shape[1] > 1:
        raise ValueError(f"the design has {matrix.shape[1]} columns: give a contrast of {matrix.shape[1]} numbers")
    weights = np.ones(1) if contrast is None else _one_row(contrast, matrix.shape[1])
    return data, Design(matrix, weights, f"contrast {' '.join(f'{weight:g}' for weight in weights)}")


def mean_or_groups(count: int, groups: ArrayLike | None, covariates: ArrayLike | None) -> Design:
    """Return the design of the mean of all maps, or of the difference of two groups, beside centred covariates.

    Parameters
    ----------
    count : int
        Number of maps, s.
    groups : (s,) array_like, optional
        Two different values; the contrast is the group that is named first less the other.
    covariates : (s,) or (s, q) array_like, optional

    Returns
    -------
    Design

    Raises
    ------
    ValueError
        If there are not two groups, or a length differs.
    """
    columns = np.empty((count, 0))
    if covariates is not None:
        given = finite_rows(covariates, count, "covariates")
        columns = given - given.mean(axis=0)
        # what is left of a constant is rounding
        columns[:, np.abs(columns).max(axis=0) <= CONSTANT * np.abs(given).max(axis=0)] = 0.0
    if groups is None:
        return Design(np.column_stack([np.ones(count), columns]), _first(1, columns), "mean")
    codes, names = two_groups(groups, count)
    matrix = np.column_stack([codes == 0, codes == 1, columns]).astype(np.float64)
    return Design(matrix, _first(2, columns), f"{names[0]} less {names[1]}")


def finite_rows(given: ArrayLike, count: int, what: str) -> Floats:
    """Return numbers with one row for each map, as a matrix.

    Parameters
    ----------
    given : (s,) or (s, p) array_like
    count : int
    what : str
        Name of the argument.

    Returns
    -------
    (s, p) float64

    Raises
    ------
    ValueError
        If a number is not finite, or there is not a row for each map.
    """
    values = real_array(given, what)
    values = values[:, None] if values.ndim == 1 else values
    if values.ndim != 2 or len(values) != count:
        raise ValueError(f"{what} have shape {np.shape(given)}, one row for each of {count} maps is needed")
    if bad := int((~np.isfinite(values)).sum()):
        raise ValueError(f"{what} have {bad} values that are NaN: leave these maps out, a number is needed for each")
    return values


def codes_of(given: ArrayLike, count: int, what: str) -> tuple[Integers, list[str]]:
    """Return labels as numbers from 0, in the order in which they are named first, with the names.

    Parameters
    ----------
    given : (s,) array_like
        Text or numbers.
    count : int
    what : str
        Name of the argument.

    Returns
    -------
    (s,) int64
    list of str

    Raises
    ------
    ValueError
        If there is not one for each map, or one is missing.
    """
    array: np.ndarray = np.ma.asanyarray(given)
    if array.shape != (count,):
        raise ValueError(f"{what} have shape {array.shape}, one label for each of {count} maps is needed")
    # what a masked array hides is None
    labels = [one.decode("utf-8", "replace") if isinstance(one, bytes) else one for one in array.tolist()]
    missing = [k for k, one in enumerate(labels) if one is None or str(one).strip().lower() in UNKNOWN]
    if missing:
        raise ValueError(
            f"{what} have no label for {len(missing)} of {count} maps (the first is number {missing[0]}, "
            f"{labels[missing[0]]!r}): leave these maps out, or name what they belong to"
        )
    known: dict[str, int] = {}
    return np.array([known.setdefault(str(one), len(known)) for one in labels], dtype=np.int64), list(known)


def two_groups(given: ArrayLike, count: int) -> tuple[Integers, list[str]]:
    """Return to which of two groups each map belongs, 0 for the one that is named first, and their names.

    Parameters
    ----------
    given : (s,) array_like
    count : int

    Returns
    -------
    (s,) int64
    list of str

    Raises
    ------
    ValueError
        If there are not two.
    """
    codes, names = codes_of(given, count, "groups")
    if len(names) != 2:
        raise ValueError(f"groups name {len(names)} ({', '.join(names[:5])}), exactly 2 are needed")
    return codes, names


def differences_of_pairs(data: Floats, groups: ArrayLike, pairs: ArrayLike) -> tuple[Floats, str]:
    """Return of each pair the map of the group that is named first less that of the other.

    Parameters
    ----------
    data : (s, n) float64
    groups, pairs : (s,) array_like

    Returns
    -------
    (s / 2, n) float64
    str
        What is tested.

    Raises
    ------
    ValueError
        If a pair has not one map of each group.
    """
    side, names = two_groups(groups, len(data))
    owner, owners = codes_of(pairs, len(data), "pairs")
    for pair, name in enumerate(owners):
        if sorted(side[owner == pair].tolist()) != [0, 1]:
            found = ", ".join(names[k] for k in side[owner == pair])
            raise ValueError(f"pair {name} has the maps {found}: one {names[0]} and one {names[1]} are needed")
    first, second = (np.flatnonzero(side == k)[np.argsort(owner[side == k])] for k in (0, 1))
    return data[first] - data[second], f"{names[0]} less {names[1]} in pairs"


def _one_row(contrast: ArrayLike, count: int) -> Floats:
    """The numbers of a contrast, which may be a matrix of one row."""
    numbers = real_array(contrast, "contrast")
    if numbers.ndim == 2 and len(numbers) == 1:
        numbers = numbers[0]
    if numbers.shape != (count,) or not np.isfinite(numbers).all():
        raise ValueError(
            f"contrast has shape {numbers.shape}: one row of {count} finite numbers is needed, one for each column of the design"
        )
    return numbers


def _first(count: int, columns: Floats) -> Floats:
    """The contrast of the mean, or of the first two columns, that leaves out covariates."""
    contrast = np.zeros(count + columns.shape[1])
    contrast[:count] = (1.0, -1.0)[:count]
    return contrast
