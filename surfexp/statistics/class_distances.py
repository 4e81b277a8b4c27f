"""Mean distances between classes, and which pair of them is closest."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.statistics.distance_matrix import DistanceMatrix
from surfexp.statistics.statistic import Statistic


def class_distances(matrix: DistanceMatrix, first: str = "", second: str = "") -> Statistic:
    """Average distances over all members of each pair of classes, in units of the mean of all pairs.

    Parameters
    ----------
    matrix : DistanceMatrix
    first, second : str
        A pair that is looked at, where the collection has both.

    Returns
    -------
    Statistic
        Rows are pairs of classes from near to far, column "distance". Metrics: members, nearest, farthest, and where a pair
        is named relatives (its distance) and relatives_rank (1 is the closest). A note names a pair that is not there.

    Raises
    ------
    ValueError
        If there are fewer than two classes.
    """
    names, distances = pair_distances(matrix)
    pairs = {(names[a], names[b]): float(distances[a, b]) for a in range(len(names)) for b in range(a + 1, len(names))}
    mean = float(np.mean(list(pairs.values())))
    ordered = sorted(pairs, key=lambda pair: pairs[pair])
    values = np.array([pairs[pair] / mean for pair in ordered])
    metrics = {"members": float(len(matrix.labels)), "nearest": float(values[0]), "farthest": float(values[-1])}
    wanted = tuple(sorted((first, second)))
    notes: tuple[str, ...] = ()
    if wanted in pairs:
        metrics["relatives"] = float(values[ordered.index(wanted)])
        metrics["relatives_rank"] = float(ordered.index(wanted) + 1)
    elif first or second:
        notes = (f"The classes {first!r} and {second!r} are not both among {', '.join(names)}: they have no rank.",)
    closest = f"The closest classes are {ordered[0][0]} and {ordered[0][1]}, the farthest {ordered[-1][0]} and {ordered[-1][1]}."
    rows = tuple(f"{a}, {b}" for a, b in ordered)
    return Statistic(
        f"distances between classes by {matrix.name}", {"distance": values}, rows, metrics, (closest, *notes)
    )


def pair_distances(matrix: DistanceMatrix) -> tuple[list[str], Floats]:
    """Return the class names, sorted, and the (c, c) mean distances between their members, 0 on the diagonal.

    Raises
    ------
    ValueError
        If there are fewer than two classes.
    """
    names = sorted(set(matrix.classes))
    if len(names) < 2:
        raise ValueError(f"the collection has one class, {names[0]!r}: distances between classes need at least 2")
    belongs = np.equal.outer(np.array(names), np.array(matrix.classes)).astype(np.float64)
    sizes = belongs.sum(axis=1)
    means = np.asarray(belongs @ matrix.values @ belongs.T / np.outer(sizes, sizes))
    np.fill_diagonal(means, 0.0)
    return names, means
