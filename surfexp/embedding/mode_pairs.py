"""Which mode of one surface is which of another, and with which sign: by order, by correlation, and what is true."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from surfexp.contract.arrays import Floats, Integers

Rule = Literal["skewness", "largest"]
# a mode has one counterpart at most with more than half of its square, for the target's modes are orthonormal (Bessel)
HALF = 0.5


@dataclass(frozen=True, eq=False)
class ModePairs:
    """The partner of each mode of the source.

    Parameters
    ----------
    partners : (k,) int64
        Mode of the target, counted from 0; -1 where there is none.
    signs : (k,) int8
        Sign that the partner takes; 0 where there is none.
    """

    partners: Integers
    signs: NDArray[np.int8]

    @property
    def paired(self) -> NDArray[np.bool_]:
        """(k,) where there is a partner."""
        return np.asarray(self.partners >= 0)

    def agrees(self, other: ModePairs, signs: bool = True) -> NDArray[np.bool_]:
        """(k,) where both have the same partner, and the same sign unless `signs` is false; having none agrees as well."""
        same = self.partners == other.partners
        return np.asarray(same & (self.signs == other.signs) if signs else same)


def mode_correlations(source: Floats, target: Floats, target_weights: Floats, rows: Integers) -> Floats:
    """Return the correlation by area of each mode of the target with each of the source, carried over by a map.

    Parameters
    ----------
    source, target : (s, k), (t, l) float64
        Modes by columns, without the constant.
    target_weights : (t,) float64
        Areas of the target's vertices.
    rows : (t,) int64
        Source vertex of each target vertex.

    Returns
    -------
    (l, k) float64
        In the order of a functional map: to target modes from source modes.
    """
    weights = target_weights / target_weights.sum()

    def normed(values: Floats) -> Floats:
        centred = values - weights @ values
        return np.asarray(centred / np.sqrt(weights @ centred**2))

    return np.asarray((normed(target) * weights[:, None]).T @ normed(source[rows]))


def counterparts(correlations: Floats, share: float = HALF) -> ModePairs:
    """Return the pairs of which each is the other's nearest, with more than a share of its square.

    Modes that mix, as near crossings of eigenvalues, have no counterpart: that is an answer too.

    Parameters
    ----------
    correlations : (l, k) float64
    share : float
        Least squared correlation.

    Raises
    ------
    ValueError
        If the share is not from 0 to below 1.
    """
    if not 0.0 <= share < 1.0:
        raise ValueError(f"share = {share:g} of the square, take one from 0 to below 1")
    squares = correlations**2
    best = squares.argmax(axis=0)
    columns = np.arange(correlations.shape[1])
    mutual = (squares.argmax(axis=1)[best] == columns) & (squares[best, columns] > share)
    return _pairs(np.where(mutual, best, -1), correlations)


def pairs_by_correlation(correlations: Floats) -> ModePairs:
    """Return the one-to-one pairs with the largest sum of absolute correlations; every mode gets a partner if there are
    as many.
    """
    targets, sources = linear_sum_assignment(-np.abs(correlations))
    partners = np.full(correlations.shape[1], -1, np.int64)
    partners[sources] = targets
    return _pairs(partners, correlations)


def pairs_in_order(
    source: Floats, target: Floats, source_weights: Floats, target_weights: Floats, rule: Rule = "skewness"
) -> ModePairs:
    """Pair mode k with mode k; signs so that both have a positive third moment, or a positive entry of largest modulus.

    Parameters
    ----------
    source, target : (s, k), (t, k) float64
    source_weights, target_weights : (s,), (t,) float64
        Areas of the vertices, for the third moment.
    rule : "skewness" or "largest"

    Raises
    ------
    ValueError
        If the rule is unknown, or the numbers of modes differ.
    """
    if rule not in ("skewness", "largest"):
        raise ValueError(f"rule {rule!r} is unknown, choose skewness or largest")
    count = source.shape[1]
    if target.shape[1] != count:
        raise ValueError(f"{count} modes against {target.shape[1]}, pairs in order need as many")
    given = [_own_sign(*each, rule) for each in ((source, source_weights), (target, target_weights))]
    return ModePairs(np.arange(count), np.asarray(given[0] * given[1], np.int8))


def _own_sign(modes: Floats, weights: Floats, rule: Rule) -> Floats:
    if rule == "skewness":
        return np.where(weights @ modes**3 < 0.0, -1.0, 1.0)
    return np.where(modes[np.abs(modes).argmax(axis=0), np.arange(modes.shape[1])] < 0.0, -1.0, 1.0)


def _pairs(partners: Integers, correlations: Floats) -> ModePairs:
    signs = np.where(correlations[partners, np.arange(len(partners))] < 0.0, -1, 1)
    return ModePairs(np.asarray(partners, np.int64), np.where(partners < 0, 0, signs).astype(np.int8))
