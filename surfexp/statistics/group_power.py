"""Whether two groups differ in a matrix of distances, and how large groups have to be to tell."""

from __future__ import annotations

from itertools import combinations
from math import comb
from typing import Literal

import numpy as np

from surfexp.mesh.triangle_mesh import Floats, Integers
from surfexp.statistics.distance_matrix import DistanceMatrix
from surfexp.statistics.resampling import exact_interval
from surfexp.statistics.statistic import Statistic

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
        What changes groups in a permutation. Members of one person are alike and not exchangeable one by one, so that
        permuting them rejects too often; with "person" whole people are drawn and permuted, all splits where they are few.

    Returns
    -------
    Statistic
        Columns: size, power, false alarms (both groups drawn from the first class), and their exact 95 % intervals over
        draws, low and high. Metrics: "power N" for each size, false_alarms, false_alarms_low and false_alarms_high (of the
        largest groups), least_p (that a split of the largest groups can have), and p_value of the whole collection.

    Raises
    ------
    ValueError
        If there are not two classes, a size cannot be drawn, or the unit is unknown.
    """
    names = sorted(set(matrix.classes))
    if len(names) != 2:
        raise ValueError(f"the collection has the classes {', '.join(names)}: a comparison of groups needs exactly 2")
    if unit not in ("member", "person"):
        raise ValueError(f"unit {unit!r} is unknown, choose member or person")
    first, second = (np.flatnonzero(np.array(matrix.classes) == name) for name in names)
    owners = np.unique(np.array(matrix.groups), return_inverse=True)[1]
    units = owners if unit == "person" else np.arange(len(owners))
    rng = np.random.default_rng(seed)
    hits = np.zeros((2, len(sizes)), np.int64)
    for column, size in enumerate(sizes):
        for row, other in enumerate((second, first)):
            pairs = _drawn(first, other, owners, size, draws, rng, unit)
            hits[row, column] = sum(
                p_value(matrix.values, *groups, permutations, rng, units) <= level + ROUNDING for groups in pairs
            )
    low, high = np.array([[exact_interval(int(hit), draws) for hit in row] for row in hits]).transpose(2, 0, 1)
    power, alarms = hits / draws
    metrics = {f"power {size}": float(share) for size, share in zip(sizes, power, strict=True)}
    metrics |= {"false_alarms": float(alarms[-1]), "false_alarms_low": float(low[1, -1])}
    metrics |= {"false_alarms_high": float(high[1, -1]), "level": level}
    metrics["least_p"] = 2.0 / comb(2 * sizes[-1], sizes[-1])
    metrics["p_value"] = p_value(matrix.values, first, second, 999, rng, np.arange(len(owners)))
    columns = {"size": np.array(sizes, dtype=float), "power": power, "power low": low[0], "power high": high[0]}
    columns |= {"false alarms": alarms, "false alarms low": low[1], "false alarms high": high[1]}
    notes: tuple[str, ...] = ()
    if metrics["least_p"] > level:
        notes = (f"No split of {sizes[-1]} against {sizes[-1]} has a p-value under {metrics['least_p']:.2g}.",)
    return Statistic(f"power to tell {names[0]} from {names[1]} by {matrix.name}", columns, (), metrics, notes)


def energy_distance(distances: Floats, first: Integers, second: Integers) -> float:
    """Return 2 E|X - Y| - E|X - X'| - E|Y - Y'| over members of two groups (Szekely and Rizzo 2004)."""
    within = sum(distances[np.ix_(some, some)].sum() / len(some) ** 2 for some in (first, second))
    return float(2.0 * distances[np.ix_(first, second)].mean() - within)


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
    pairs = []
    people = np.unique(owners)
    half = size if unit == "person" else len(people) // 2
    if 2 * half > len(people):
        raise ValueError(f"groups of {size} people cannot be drawn: there are {len(people)}, take at most half of them")
    for _ in range(draws):
        order = rng.permutation(people)
        others = order[half : 2 * half] if unit == "person" else order[half:]
        left, right = first[np.isin(owners[first], order[:half])], second[np.isin(owners[second], others)]
        if min(len(left), len(right)) < size:
            raise ValueError(
                f"groups of {size} cannot be drawn: half of the people have {min(len(left), len(right))} members"
            )
        if unit == "member":
            left, right = (rng.choice(some, size, replace=False) for some in (left, right))
        pairs.append((left, right))
    return pairs
