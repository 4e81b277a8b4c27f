"""Rearrangements of observations under the null hypothesis: all that differ where these are few, else random ones."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from math import factorial, prod

import numpy as np

from surfexp.contract.arrays import Floats, Integers

# a column that differs by no more of its largest modulus differs by rounding
CONSTANT = 1e-13


@dataclass(frozen=True, eq=False)
class Rearrangements:
    """What takes the place of each observation, and with which sign.

    Parameters
    ----------
    sources : (r, s) int64
        Which observation stands in the place of each.
    signs : (r, s) float64
    complete : bool
        Whether these are all rearrangements that differ, each once; else the first one changes nothing and all others are
        drawn at random.
    """

    sources: Integers
    signs: Floats
    complete: bool

    def __len__(self) -> int:
        return len(self.sources)

    def part(self, start: int, stop: int) -> Rearrangements:
        """Return some of them.

        Parameters
        ----------
        start, stop : int

        Returns
        -------
        Rearrangements
        """
        return Rearrangements(self.sources[start:stop], self.signs[start:stop], self.complete)

    def carried(self, weights: Floats) -> Floats:
        """Return weights on the data whose sum is that of given weights on the rearranged data.

        Parameters
        ----------
        weights : (s,) float64

        Returns
        -------
        (r, s) float64
        """
        carried = np.empty(self.sources.shape)
        np.put_along_axis(carried, self.sources, self.signs * weights, axis=1)
        return carried


def unchanged(count: int) -> Rearrangements:
    """Return the one that changes nothing.

    Parameters
    ----------
    count : int
        Number of observations.

    Returns
    -------
    Rearrangements
    """
    return Rearrangements(np.arange(count)[None], np.ones((1, count)), False)


def sign_flips(units: Integers, most: int, random: np.random.Generator) -> Rearrangements:
    """Return flips of the signs of units of observations.

    Parameters
    ----------
    units : (s,) int64
        Observations of one unit flip together; numbered from 0.
    most : int
        All 2^u are made if they are no more; else so many, with repetition.
    random : numpy.random.Generator

    Returns
    -------
    Rearrangements
    """
    count = int(units.max()) + 1
    complete = 2**count <= most
    if complete:
        signs = np.array(list(product((1.0, -1.0), repeat=count)))
    else:
        signs = random.choice(np.array([1.0, -1.0]), (most, count))
        signs[0] = 1.0
    sources = np.broadcast_to(np.arange(len(units)), (len(signs), len(units)))
    return Rearrangements(sources, signs[:, units], complete)


def permutations(
    units: Integers, strata: Integers, rows: Floats, most: int, random: np.random.Generator
) -> Rearrangements:
    """Return permutations of units of observations within strata.

    Parameters
    ----------
    units : (s,) int64
        Observations of one unit move together, in their order; numbered from 0.
    strata : (u,) int64
        Units of one stratum change places; they have the same number of observations.
    rows : (s, p) float64
        The design. Units of equal rows are not told apart, so that permutations among them are not counted.
    most : int
        All that differ are made if they are no more; else so many, with repetition.
    random : numpy.random.Generator

    Returns
    -------
    Rearrangements
    """
    members = [np.flatnonzero(units == unit) for unit in range(len(strata))]
    classes = _classes(rows)
    kinds: dict[tuple[int, ...], int] = {}
    kind = np.array([kinds.setdefault(tuple(classes[one].tolist()), len(kinds)) for one in members])
    places = [np.flatnonzero(strata == stratum) for stratum in np.unique(strata)]
    complete = prod(_differing(kind[inside]) for inside in places) <= most
    moved = np.tile(np.arange(len(strata)), (1 if complete else most, 1))
    if complete:
        each = [[_sources(inside, kind[inside], order) for order in _orders(kind[inside])] for inside in places]
        moved = np.array([_combined(places, chosen, len(strata)) for chosen in product(*each)])
    else:
        for inside in places:
            moved[1:, inside] = random.permuted(moved[1:, inside], axis=1)
    sources = np.empty((len(moved), len(units)), dtype=np.int64)
    for unit, place in enumerate(members):
        sources[:, place] = np.array([members[source] for source in moved[:, unit]])
    return Rearrangements(sources, np.ones(sources.shape), complete)


def _classes(rows: Floats) -> Integers:
    """Numbers of rows, the same where they are equal to rounding, whatever the units and the origins of the columns are."""
    lowest, spread = rows.min(axis=0), np.ptp(rows, axis=0)
    constant = spread <= CONSTANT * np.abs(rows).max(axis=0)
    shares = np.where(constant, 0.0, (rows - lowest) / np.where(constant, 1.0, spread))
    return np.unique(np.round(shares, 10), axis=0, return_inverse=True)[1].reshape(-1).astype(np.int64)


def _differing(kinds: Integers) -> int:
    """How many orders of these kinds there are."""
    return factorial(len(kinds)) // prod(factorial(int(count)) for count in np.unique(kinds, return_counts=True)[1])


def _orders(kinds: Integers) -> Iterator[list[int]]:
    """Every order of some kinds once, from the smallest, by the next in lexicographic order."""
    order = sorted(kinds.tolist())
    while True:
        yield list(order)
        at = len(order) - 2
        while at >= 0 and order[at] >= order[at + 1]:
            at -= 1
        if at < 0:
            return
        other = len(order) - 1
        while order[other] <= order[at]:
            other -= 1
        order[at], order[other] = order[other], order[at]
        order[at + 1 :] = order[:at:-1]


def _sources(inside: Integers, kinds: Integers, order: list[int]) -> Integers:
    """Which unit stands at each place where the k-th unit is given the design of a unit of kind order[k]."""
    sources = np.empty(len(inside), dtype=np.int64)
    for kind in np.unique(kinds):
        sources[kinds == kind] = inside[np.array(order) == kind]
    return sources


def _combined(places: list[Integers], chosen: tuple[Integers, ...], count: int) -> Integers:
    moved = np.empty(count, dtype=np.int64)
    for inside, sources in zip(places, chosen, strict=True):
        moved[inside] = sources
    return moved
