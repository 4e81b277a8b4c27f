"""Rank-one identification: whose original is nearest to a person seen again, and how sure the share is."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.contract.member import Member
from surfexp.statistics.resampling import bootstrap_interval, exact_interval

Person = tuple[str, float]
Result = TypeVar("Result")


@dataclass(frozen=True, eq=False)
class Recognition:
    """Answers for one change of surface.

    Parameters
    ----------
    nearest : (p,) int64
        Which original is nearest to person i seen again; -1 where two are equally near.
    donors : (p,) int64
        Number of the donor of each person.
    """

    nearest: Integers
    donors: Integers

    @property
    def right(self) -> np.ndarray:
        """(p,) bool, who is recognised."""
        return np.asarray(self.nearest == np.arange(len(self.nearest)))

    def rank_one(self) -> tuple[float, float, float]:
        """Share of people recognised, with the 95 % interval of Clopper and Pearson: people count as independent."""
        hits, trials = int(self.right.sum()), len(self.right)
        low, high = exact_interval(hits, trials)
        return hits / trials, low, high

    def by_donor(self, seed: int = 0) -> tuple[float, float, float]:
        """The same share with a bootstrap interval over donors, whose people are alike."""
        low, high = bootstrap_interval(self.right, self.donors, np.random.default_rng(seed))
        return float(self.right.mean()), low, high

    def donor_right(self) -> float:
        """Share of people whose donor at least is recognised."""
        return float(((self.nearest >= 0) & (self.donors[self.nearest] == self.donors)).mean())


def recognition(distances: Floats, donors: Sequence[str]) -> Recognition:
    """Read the answers off distances.

    Parameters
    ----------
    distances : (p, p) float64
        From person i seen again to the original of person j.
    donors : sequence of p str

    Raises
    ------
    ValueError
        If the matrix is not square, or not finite.
    """
    count = len(donors)
    if distances.shape != (count, count) or not np.isfinite(distances).all():
        raise ValueError(f"distances have shape {distances.shape}, ({count}, {count}) finite ones are needed")
    least = distances.min(axis=1)
    nearest = np.where((distances == least[:, None]).sum(axis=1) > 1, -1, distances.argmin(axis=1))
    return Recognition(nearest.astype(np.int64), np.unique(np.asarray(donors), return_inverse=True)[1].astype(np.int64))


def by_change(results: Mapping[Member, Result], reference: str = "original") -> dict[str, dict[Person, Result]]:
    """Arrange what belongs to members by change and person, the reference first, people in one order.

    Parameters
    ----------
    results : mapping of Member to anything
        The class of a member is the change, its group the donor, its level the number of the person.
    reference : str

    Raises
    ------
    ValueError
        If the reference is missing, or a change does not have the same people.
    """
    found: dict[str, dict[Person, Result]] = {reference: {}}
    for member, result in results.items():
        if member.level is None:
            raise ValueError(f"member {member.label!r} has no level, the number of the subject: write level: NUMBER")
        found.setdefault(member.class_name, {})[member.group, member.level] = result
    people = list(found[reference])
    if len(people) < 2 or len(found) < 2:
        raise ValueError(
            f"{len(people)} subjects of class {reference!r} and {len(found) - 1} changes: take 2 and 1 at least"
        )
    for change, seen in found.items():
        if set(seen) != set(people):
            raise ValueError(
                f"change {change!r} has {len(seen)} subjects, {reference!r} has {len(people)}: the same are needed"
            )
    return {change: {person: seen[person] for person in people} for change, seen in found.items()}


def donors_of(people: Iterable[Person]) -> tuple[str, ...]:
    """The donor of each person."""
    return tuple(donor for donor, _ in people)
