"""Distances between classes of a collection, the readings of figure 4.8."""

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.statistics.class_distances import class_distances
from surfexp.statistics.class_readings import class_readings

CLASS_DISTANCES_METRICS = {
    "members": Metric("members of the collection"),
    "nearest": Metric("mean distance of the closest pair of classes"),
    "farthest": Metric("mean distance of the farthest pair of classes"),
    "relatives": Metric("mean distance of the two related classes"),
    "relatives_rank": Metric("rank of the related pair among all pairs, 1 is the closest"),
}


register(
    "statistic",
    "class_distances",
    metrics=CLASS_DISTANCES_METRICS,
    options={
        "first": Field(description="one class of a pair that is ranked"),
        "second": Field(description="the other class of the pair"),
    },
    names={"matrix": "distance_matrix"},
)(class_distances)


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


register(
    "statistic",
    "class_readings",
    metrics=CLASS_READINGS_METRICS,
    options={
        "near": Field(
            [
                ("cat", "lioness"),
                ("david", "michael"),
            ],
            description="pairs of classes that are said to be close",
        ),
        "outlying": Field(["centaur"], description="classes that are said to be far from all others"),
    },
    names={"matrix": "distance_matrix"},
)(class_readings)
