"""Classifiers with grouped cross-validation: no person or object stands in training and test sets at once."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.statistics.classifiers import classify

OPTIONS = {
    "permutations": Field(ge=0, le=100000, description="permutations of the classes for the p-value"),
    "seed": Field(ge=0, description="seed of permutations, bootstrap and forests"),
}
NEIGHBOURS = {"neighbours": Field(ge=1, le=1000, description="neighbours that vote")}
NAMES = {"matrix": "distance_matrix"}

register(
    "classifier",
    "nearest_neighbour",
    summary="The class of the nearest member of another group.",
    given={"method": "nearest_neighbour"},
    options=OPTIONS,
    names=NAMES,
)(classify)

register(
    "classifier",
    "k_nearest",
    summary="The class of most among the k nearest members of other groups.",
    given={"method": "k_nearest"},
    options={**OPTIONS, **NEIGHBOURS},
    names=NAMES,
)(classify)

register(
    "classifier",
    "nearest_centroid",
    summary="The class whose centre, over the other groups, is nearest in standardised coordinates.",
    given={"method": "nearest_centroid"},
    options=OPTIONS,
    names=NAMES,
)(classify)

register(
    "classifier",
    "support_vectors",
    summary="Support vectors with a Gaussian kernel on standardised coordinates.",
    given={"method": "support_vectors"},
    options=OPTIONS,
    names=NAMES,
)(classify)

register(
    "classifier",
    "random_forest",
    summary="Sixty random trees on the coordinates, seeded.",
    given={"method": "random_forest"},
    options=OPTIONS,
    names=NAMES,
)(classify)
