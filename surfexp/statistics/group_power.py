"""Whether two groups differ in a matrix of distances, and how large groups have to be to tell."""

from __future__ import annotations

import numpy as np

from surfexp.mesh.triangle_mesh import Floats, Integers
from surfexp.statistics.distance_matrix import DistanceMatrix
from surfexp.statistics.statistic import Statistic


def group_power(
    matrix: DistanceMatrix,
    sizes: list[int],
    level: float = 0.05,
    draws: int = 200,
    permutations: int = 199,
    seed: int = 0,
) -> Statistic:
    """Draw groups of each size from the two classes, test them, and report how often a difference is found.

    The statistic is the energy distance of the two groups; its p-value comes from permutations. A person or object is
    drawn into one of the groups only.

    Parameters
    ----------
    matrix : DistanceMatrix
        Of exactly two classes.
    sizes : list of int
        Members of each group, increasing.
    level : float
        Of the test.
    draws, permutations, seed : int

    Returns
    -------
    Statistic
        Columns: size, power, false alarms (both groups drawn from the first class). Metrics: "power N" for each size,
        "false_alarms" (of the largest groups), and p_value of the whole collection.

    Raises
    ------
    ValueError
        If there are not two classes, or a size cannot be drawn.
    """
    names = sorted(set(matrix.classes))
    if len(names) != 2:
        raise ValueError(f"the collection has the classes {', '.join(names)}: a comparison of groups needs exactly 2")
    first, second = (np.flatnonzero(np.array(matrix.classes) == name) for name in names)
    owners = np.unique(np.array(matrix.groups), return_inverse=True)[1]
    rng = np.random.default_rng(seed)
    power, alarms = [], []
    for size in sizes:
        found = [
            [
                _rejects(matrix.values, groups, level, permutations, rng)
                for groups in _drawn(first, other, owners, size, draws, rng)
            ]
            for other in (second, first)
        ]
        power.append(float(np.mean(found[0])))
        alarms.append(float(np.mean(found[1])))
    everything = p_value(matrix.values, first, second, 999, rng)
    metrics = {f"power {size}": share for size, share in zip(sizes, power, strict=True)}
    metrics |= {"false_alarms": alarms[-1], "p_value": everything, "level": level}
    columns = {"size": np.array(sizes, dtype=float), "power": np.array(power), "false alarms": np.array(alarms)}
    return Statistic(f"power to tell {names[0]} from {names[1]} by {matrix.name}", columns, metrics=metrics)


def energy_distance(distances: Floats, first: Integers, second: Integers) -> float:
    """Return 2 E|X - Y| - E|X - X'| - E|Y - Y'| over members of two groups (Szekely and Rizzo 2004)."""
    within = sum(distances[np.ix_(some, some)].sum() / len(some) ** 2 for some in (first, second))
    return float(2.0 * distances[np.ix_(first, second)].mean() - within)


def p_value(distances: Floats, first: Integers, second: Integers, permutations: int, rng: np.random.Generator) -> float:
    """Return the share of permutations, the true one counted in, whose energy distance is at least that of the groups."""
    together = np.concatenate([first, second])
    block, size = distances[np.ix_(together, together)], len(first)
    signs = np.ones((permutations + 1, len(together)))
    signs[0, size:] = -1.0
    for row in signs[1:]:
        row[rng.permutation(len(together))[size:]] = -1.0
    # with u = 1/m on one group and -1/n on the other the energy distance is -u^T D u
    weights = np.where(signs > 0, 1.0 / size, -1.0 / (len(together) - size))
    energies = -np.einsum("pi,ij,pj->p", weights, block, weights, optimize=True)
    return float((energies >= energies[0] - 1e-12 * abs(energies[0])).mean())


def _rejects(
    distances: Floats, groups: tuple[Integers, Integers], level: float, permutations: int, rng: np.random.Generator
) -> bool:
    return p_value(distances, *groups, permutations, rng) <= level


def _drawn(
    first: Integers, second: Integers, owners: Integers, size: int, draws: int, rng: np.random.Generator
) -> list[tuple[Integers, Integers]]:
    """Pairs of groups of a size, no owner in both."""
    pairs = []
    people = np.unique(owners)
    for _ in range(draws):
        mine = rng.permutation(people)[: len(people) // 2]
        left, right = first[np.isin(owners[first], mine)], second[~np.isin(owners[second], mine)]
        if min(len(left), len(right)) < size:
            raise ValueError(
                f"groups of {size} cannot be drawn: half of the people have {min(len(left), len(right))} members"
            )
        pairs.append((rng.choice(left, size, replace=False), rng.choice(right, size, replace=False)))
    return pairs
