"""Classifiers with grouped cross-validation: no person or object stands in training and test sets at once."""

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.statistics.classification import Classification
from surfexp.statistics.classifiers import classify
from surfexp.statistics.distance_matrix import DistanceMatrix


class Grouped(Options):
    """How chance is measured."""

    permutations: int = Field(200, ge=0, le=100000, description="permutations of the classes for the p-value")
    seed: int = Field(0, ge=0, description="seed of permutations, bootstrap and forests")


class Neighbours(Grouped):
    """How chance is measured, and how many neighbours vote."""

    neighbours: int = Field(3, ge=1, le=1000, description="neighbours that vote")


@register("classifier", "nearest_neighbour")
def nearest_neighbour(options: Grouped, *, distance_matrix: DistanceMatrix) -> Classification:
    """The class of the nearest member of another group."""
    return classify(distance_matrix, "nearest_neighbour", **dict(options))


@register("classifier", "k_nearest")
def k_nearest(options: Neighbours, *, distance_matrix: DistanceMatrix) -> Classification:
    """The class of most among the k nearest members of other groups."""
    return classify(distance_matrix, "k_nearest", **dict(options))


@register("classifier", "nearest_centroid")
def nearest_centroid(options: Grouped, *, distance_matrix: DistanceMatrix) -> Classification:
    """The class whose centre, over the other groups, is nearest in standardised coordinates."""
    return classify(distance_matrix, "nearest_centroid", **dict(options))


@register("classifier", "support_vectors")
def support_vectors(options: Grouped, *, distance_matrix: DistanceMatrix) -> Classification:
    """Support vectors with a Gaussian kernel on standardised coordinates."""
    return classify(distance_matrix, "support_vectors", **dict(options))


@register("classifier", "random_forest")
def random_forest(options: Grouped, *, distance_matrix: DistanceMatrix) -> Classification:
    """Sixty random trees on the coordinates, seeded."""
    return classify(distance_matrix, "random_forest", **dict(options))
