"""Classifiers with grouped cross-validation: no person or object stands in training and test sets at once."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.statistics.classification import Classification
from surfexp.statistics.classifiers import classify
from surfexp.statistics.distance_matrix import DistanceMatrix

Permutations = Annotated[int, Field(ge=0, le=100000, description="permutations of the classes for the p-value")]
Seed = Annotated[int, Field(ge=0, description="seed of permutations, bootstrap and forests")]


@register("classifier", "nearest_neighbour", defaults_of=classify)
def nearest_neighbour(distance_matrix: DistanceMatrix, *, permutations: Permutations, seed: Seed) -> Classification:
    """The class of the nearest member of another group."""
    return classify(distance_matrix, "nearest_neighbour", permutations=permutations, seed=seed)


@register("classifier", "k_nearest", defaults_of=classify)
def k_nearest(
    distance_matrix: DistanceMatrix,
    *,
    permutations: Permutations,
    seed: Seed,
    neighbours: Annotated[int, Field(ge=1, le=1000, description="neighbours that vote")],
) -> Classification:
    """The class of most among the k nearest members of other groups."""
    return classify(distance_matrix, "k_nearest", permutations=permutations, seed=seed, neighbours=neighbours)


@register("classifier", "nearest_centroid", defaults_of=classify)
def nearest_centroid(distance_matrix: DistanceMatrix, *, permutations: Permutations, seed: Seed) -> Classification:
    """The class whose centre, over the other groups, is nearest in standardised coordinates."""
    return classify(distance_matrix, "nearest_centroid", permutations=permutations, seed=seed)


@register("classifier", "support_vectors", defaults_of=classify)
def support_vectors(distance_matrix: DistanceMatrix, *, permutations: Permutations, seed: Seed) -> Classification:
    """Support vectors with a Gaussian kernel on standardised coordinates."""
    return classify(distance_matrix, "support_vectors", permutations=permutations, seed=seed)


@register("classifier", "random_forest", defaults_of=classify)
def random_forest(distance_matrix: DistanceMatrix, *, permutations: Permutations, seed: Seed) -> Classification:
    """Sixty random trees on the coordinates, seeded."""
    return classify(distance_matrix, "random_forest", permutations=permutations, seed=seed)
