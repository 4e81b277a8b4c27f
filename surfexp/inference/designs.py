"""Designs of common tests: a mean, two groups, pairs, each with covariates."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from surfexp.contract.arrays import Floats
from surfexp.inference.labels_of_maps import blocks_of_pairs, differences_of_pairs, two_groups
from surfexp.inference.rearrangements import CONSTANT
from surfexp.mesh.given_arrays import real_array


@dataclass(frozen=True, eq=False)
class Design:
    """A linear model of maps and the contrast that is tested.

    Parameters
    ----------
    matrix : (s, p) float64
    contrast : (p,) float64
    words : str
        What is tested.
    blocks : (s,) array_like, optional
        Labels of rows that depend on one another.
    """

    matrix: Floats
    contrast: Floats
    words: str
    blocks: ArrayLike | None = None


def tested(
    data: Floats,
    design: ArrayLike | None,
    contrast: ArrayLike | None,
    groups: ArrayLike | None,
    pairs: ArrayLike | None,
    covariates: ArrayLike | None,
    blocks: ArrayLike | None = None,
) -> tuple[Floats, Design]:
    """Return what is fitted, the data or the differences of pairs, and the design.

    Parameters
    ----------
    data : (s, n) float64
    design : (s, p) array_like, optional
    contrast : (p,) array_like, optional
    groups, pairs : (s,) array_like, optional
    covariates : (s,) or (s, q) array_like, optional
    blocks : (s,) array_like, optional

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
            return data, replace(mean_or_groups(len(data), groups, covariates), blocks=blocks)
        if groups is None or covariates is not None:
            raise ValueError("pairs need groups and take no covariates: give groups, or a design with a column a pair")
        differences, words = differences_of_pairs(data, groups, pairs)
        of_pairs = None if blocks is None else blocks_of_pairs(blocks, pairs, len(data))
        return differences, replace(mean_or_groups(len(differences), None, None), words=words, blocks=of_pairs)
    beside = {"groups": groups, "pairs": pairs, "covariates": covariates}
    if twice := [name for name, value in beside.items() if value is not None]:
        raise ValueError(f"a design and {twice[0]} are given: give one of them")
    matrix = finite_rows(design, len(data), "rows of the design")
    if contrast is None and matrix.shape[1] > 1:
        raise ValueError(f"the design has {matrix.shape[1]} columns: give a contrast of {matrix.shape[1]} numbers")
    weights = np.ones(1) if contrast is None else _one_row(contrast, matrix.shape[1])
    return data, Design(matrix, weights, f"contrast {' '.join(f'{weight:g}' for weight in weights)}", blocks)


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
