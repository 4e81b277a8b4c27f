"""Whether two groups differ in a matrix of distances, and how large groups have to be to tell."""

from __future__ import annotations

from itertools import combinations
from math import comb
from typing import Literal

import numpy as np

from surfexp.contract.arrays import Integers
from surfexp.statistics.distance_matrix import DistanceMatrix
from surfexp.statistics.energy_distance_test import p_value
from surfexp.statistics.resampling import exact_interval
from surfexp.statistics.statistic import Statistic

ALARMS = ("false_alarms", "false_alarms_low", "false_alarms_high")
Unit = Literal["member", "person"]
ROUNDING = 1e-9


def group_power(
    matrix: DistanceMatrix,
    sizes: list[int],
    level: float = 0.05,
    draws: int = 200,
    permutations: int = 199,
    seed: int = 0,
    unit: Unit = "member",
    permuted: Unit | None = None,
) -> Statistic:
    """Draw groups of each size from the two classes, test them, and report how often a difference is found.

    The statistic is the energy distance of the two groups; its p-value comes from permutations. A person or object is
    drawn into one of the groups only.

    Parameters
    ----------
    matrix : DistanceMatrix
        Of exactly two classes.
    sizes : list of int
        Units in each group, increasing.
    level : float
        Of the test.
    draws, permutations, seed : int
    unit : "member" or "person"
        What is drawn into groups; whole people are drawn in all ways where these are few.
    permuted : "member" or "person", optional
        What changes groups in a permutation; default: the unit. Members of one person are alike and not exchangeable one
        by one, so that permuting them rejects too often.

    Returns
    -------
    Statistic
        Columns: size, level, and with their exact 95 % intervals over draws power and false alarms (both groups drawn from
        the first class). Metrics: "power N" for each size, false_alarms, false_alarms_low and false_alarms_high (of the
        largest groups), draws (of them), least_p (that a split of the largest groups can have), and p_value of the whole
        collection.

    Raises
    ------
    ValueError
        If there are not two classes, a size cannot be drawn, or the unit is unknown.
    """
    names = sorted(set(matrix.classes))
    if len(names) != 2:
        raise ValueError(f"the collection has the classes {', '.join(names)}: a comparison of groups needs exactly 2")
    for name in (unit, permuted or unit):
        if name not in ("member", "person"):
            raise ValueError(f"unit {name!r} is unknown, choose 'member' or 'person'")
    first, second = (np.flatnonzero(np.array(matrix.classes) == name) for name in names)
    owners = np.unique(np.array(matrix.groups), return_inverse=True)[1]
    units = owners if (permuted or unit) == "person" else np.arange(len(owners))
    rng = np.random.default_rng(seed)
    power, alarms = np.empty((len(sizes), 3)), np.empty((len(sizes), 3))
    for shares, other in ((power, second), (alarms, first)):
        for row, size in enumerate(sizes):
            pairs = _drawn(first, other, owners, size, draws, rng, unit)
            found = [p_value(matrix.values, *pair, permutations, rng, units) <= level + ROUNDING for pair in pairs]
            shares[row] = np.mean(found), *exact_interval(sum(found), len(found))
    metrics = {f"power {size}": float(share) for size, share in zip(sizes, power[:, 0], strict=True)}
    metrics |= dict(zip(ALARMS, alarms[-1].tolist(), strict=True))
    moved = [len(np.unique(units[group])) for group in pairs[-1]]
    least = (2.0 if moved[0] == moved[1] else 1.0) / comb(sum(moved), moved[0])
    metrics |= {"level": level, "draws": float(len(pairs)), "least_p": least}
    metrics["p_value"] = p_value(matrix.values, first, second, 999, rng, np.arange(len(owners)))
    levels = np.full(len(sizes), level)
    columns = {"size": np.array(sizes, dtype=float), "power": power, "false alarms": alarms, "level": levels}
    note = f"No split of {sizes[-1]} against {sizes[-1]} has a p-value under {least:.2g}."
    heading = f"power to tell {names[0]} from {names[1]} by {matrix.name}"
    return Statistic(heading, columns, (), metrics, (note,) if least > level else ())


def _drawn(
    first: Integers,
    second: Integers,
    owners: Integers,
    size: int,
    draws: int,
    rng: np.random.Generator,
    unit: Unit,
) -> list[tuple[Integers, Integers]]:
    """Pairs of groups of a size, no owner in both."""
    if unit == "person":
        drawn = _people(np.unique(owners), size, draws, rng)
        return [(first[np.isin(owners[first], one)], second[np.isin(owners[second], two)]) for one, two in drawn]
    pairs = []
    people = np.unique(owners)
    for _ in range(draws):
        mine = rng.permutation(people)[: len(people) // 2]
        left, right = first[np.isin(owners[first], mine)], second[~np.isin(owners[second], mine)]
        if min(len(left), len(right)) < size:
            raise ValueError(
                f"groups of {size} cannot be drawn: half of the subjects have {min(len(left), len(right))} members"
            )
        pairs.append((rng.choice(left, size, replace=False), rng.choice(right, size, replace=False)))
    return pairs


def _people(people: Integers, size: int, draws: int, rng: np.random.Generator) -> list[tuple[Integers, Integers]]:
    """Two groups of people without a common one: all such pairs where they are no more than the draws, else random ones."""
    if 2 * size > len(people):
        raise ValueError(
            f"groups of {size} subjects cannot be drawn: there are {len(people)}, take at most half of them"
        )
    if comb(len(people), size) * comb(len(people) - size, size) > draws:
        orders = (rng.permutation(people) for _ in range(draws))
        return [(order[:size], order[size : 2 * size]) for order in orders]
    return [
        (np.array(one), np.array(two))
        for one in combinations(people, size)
        for two in combinations(np.setdiff1d(people, one), size)
    ]
