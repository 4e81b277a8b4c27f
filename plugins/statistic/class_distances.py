"""Distances between classes of a collection, the readings of figure 4.8."""

from pydantic import Field

from surfexp.statistics.class_distances import class_distances
from surfexp.statistics.distance_matrix import DistanceMatrix
from surfexp.statistics.statistic import Statistic
from surfexp.workflow.registry import Options, register


class ClassDistances(Options):
    """Which pair of classes is looked at."""

    first: str = Field("", description="one class of a pair that is ranked")
    second: str = Field("", description="the other class of the pair")


@register("statistic", "class_distances")
def class_distances_statistic(options: ClassDistances, *, distance_matrix: DistanceMatrix) -> Statistic:
    """Mean distances between all pairs of classes, and the rank of one pair."""
    return class_distances(distance_matrix, options.first, options.second)
