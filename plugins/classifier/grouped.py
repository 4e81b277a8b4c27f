"""Classifiers with grouped cross-validation: no person or object stands in training and test sets at once."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.statistics.classifiers import classify

OPTIONS = {
    "permutations": Field(ge=0, le=100000, description="permutations of the classes for the p-value"),
    "seed": Field(ge=0, description="seed of permutations, bootstrap and forests"),
}
NEIGHBOURS = {"neighbours": Field(ge=1, le=1000, description="neighbours that vote")}
METHODS = {
    "nearest_neighbour": "The class of the nearest member of another group.",
    "k_nearest": "The class of most among the k nearest members of other groups.",
    "nearest_centroid": "The class whose centre, over the other groups, is nearest in standardised coordinates.",
    "support_vectors": "Support vectors with a Gaussian kernel on standardised coordinates.",
    "random_forest": "Sixty random trees on the coordinates, seeded.",
}

for method, summary in METHODS.items():
    register(
        "classifier",
        method,
        summary=summary,
        given={"method": method},
        options=OPTIONS | (NEIGHBOURS if method == "k_nearest" else {}),
        names={"matrix": "distance_matrix"},
    )(classify)
