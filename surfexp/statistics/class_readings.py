"""What is read off a picture of classes, as numbers: near pairs by rank, an outlying class by its mean distance."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from surfexp.statistics.class_distances import class_distances, pair_distances
from surfexp.statistics.distance_matrix import DistanceMatrix
from surfexp.statistics.statistic import Statistic


def class_readings(matrix: DistanceMatrix, near: Sequence[tuple[str, str]], outlying: Sequence[str]) -> Statistic:
    """Judge statements such as "cat and lioness are closest, the centaurs are far from the others".

    Parameters
    ----------
    matrix : DistanceMatrix
        Of any classes.
    near : sequence of pairs of class names
    outlying : sequence of class names
        A statement about a class that the collection does not have is left out, with a note.

    Returns
    -------
    Statistic
        The table of `class_distances`. Metrics for each pair: "rank A, B" among all pairs of classes (1 is the closest), and
        "rank A to B", the larger place of one among the neighbours of the other (1: each is the other's nearest). For
        each outlying class: "remoteness A", its rank by mean distance to the other classes (1 is the farthest), and "nearest A",
        its least distance in units of the mean of all pairs. Also members, classes and readings, how many were judged.
    """
    table = class_distances(matrix)
    names, distances = pair_distances(matrix)
    place = {name: i for i, name in enumerate(names)}
    metrics = {"members": float(len(matrix.labels)), "classes": float(len(names))}
    means = distances.sum(axis=1) / (len(names) - 1)
    pairs = np.sort(distances[np.triu_indices(len(names), 1)])
    absent = sorted({name for name in (*(name for pair in near for name in pair), *outlying) if name not in place})
    judged = 0
    for first, second in near:
        if first in place and second in place:
            a, b = place[first], place[second]
            metrics[f"rank {first}, {second}"] = float(1 + (pairs < distances[a, b]).sum())
            others = [int((np.delete(distances[i], i) < distances[a, b]).sum()) for i in (a, b)]
            metrics[f"rank {first} to {second}"] = float(1 + max(others))
            judged += 1
    for name in outlying:
        if name in place:
            metrics[f"remoteness {name}"] = float(1 + (means > means[place[name]]).sum())
            metrics[f"nearest {name}"] = float(np.delete(distances[place[name]], place[name]).min() / pairs.mean())
            judged += 1
    metrics["readings"] = float(judged)
    missing = (f"The collection has no class {', '.join(absent)}: nothing is said of it.",) if absent else ()
    return Statistic(table.name, table.columns, table.rows, metrics, (*table.notes, *missing))
