"""Distances between classes of a collection, the readings of figure 4.8."""

from collections.abc import Sequence
from typing import Annotated

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.statistics.class_distances import class_distances
from surfexp.statistics.class_readings import class_readings
from surfexp.statistics.distance_matrix import DistanceMatrix
from surfexp.statistics.statistic import Statistic

CLASS_DISTANCES_METRICS = {
    "members": Metric("members of the collection"),
    "nearest": Metric("mean distance of the closest pair of classes"),
    "farthest": Metric("mean distance of the farthest pair of classes"),
    "relatives": Metric("mean distance of the two related classes"),
    "relatives_rank": Metric("rank of the related pair among all pairs, 1 is the closest"),
}


@register("statistic", "class_distances", metrics=CLASS_DISTANCES_METRICS, defaults_of=class_distances)
def class_distances_statistic(
    distance_matrix: DistanceMatrix,
    *,
    first: Annotated[str, Field(description="one class of a pair that is ranked")],
    second: Annotated[str, Field(description="the other class of the pair")],
) -> Statistic:
    """Mean distances between all pairs of classes, and the rank of one pair."""
    return class_distances(distance_matrix, first, second)


CLASS_READINGS_METRICS = {
    "members": Metric("members of the collection"),
    "classes": Metric("classes of the collection"),
    "readings": Metric("readings of the figure that could be judged"),
    "nearest": Metric("mean distance of the closest pair of classes"),
    "farthest": Metric("mean distance of the farthest pair of classes"),
    "rank {first}, {second}": Metric("rank of a pair among all pairs of classes, 1 is the closest"),
    "rank {first} to {second}": Metric("place of each in the other's list of neighbours, 1 is the nearest"),
    "remoteness {name}": Metric("rank by mean distance to the other classes, 1 is the farthest"),
    "nearest {name}": Metric("distance to the nearest class over the mean distance"),
}


@register("statistic", "class_readings", metrics=CLASS_READINGS_METRICS)
def class_readings_statistic(
    distance_matrix: DistanceMatrix,
    *,
    near: Annotated[Sequence[tuple[str, str]], Field(description="pairs of classes that are said to be close")] = [
        ("cat", "lioness"),
        ("david", "michael"),
    ],
    outlying: Annotated[Sequence[str], Field(description="classes that are said to be far from all others")] = [
        "centaur"
    ],
) -> Statistic:
    """Statements about near and outlying classes as ranks of distances; those of absent classes are left out."""
    return class_readings(distance_matrix, near, outlying)
