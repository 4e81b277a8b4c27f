"""Embeddings of a collection in the plane or in space."""

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.statistics.multidimensional_scaling import (
    classical_scaling,
    manifold_embedding,
    neighbour_embedding,
    principal_components,
    stress_majorisation,
)

DIMENSIONS = Field(ge=1, le=50, description="dimension of the embedding")
SEED = Field(ge=0, description="seed of the random starts")
MATRIX = {"matrix": "distance_matrix"}

METRICS = {
    "explained": Metric("share of the positive spectrum that is shown", better="higher"),
    "negative_share": Metric("share of negative eigenvalues", better="lower"),
}

register(
    "embedding",
    "classical",
    metrics=METRICS,
    options={"dimensions": DIMENSIONS},
    names=MATRIX,
)(classical_scaling)

register(
    "embedding",
    "smacof",
    metrics={"starts": Metric("starting configurations")},
    options={"dimensions": DIMENSIONS, "seed": SEED},
    names=MATRIX,
)(stress_majorisation)

register(
    "embedding",
    "pca",
    metrics={"explained": Metric("share of the variance that is shown", better="higher")},
    options={"dimensions": DIMENSIONS},
    names=MATRIX,
)(principal_components)

register(
    "embedding",
    "tsne",
    options={"dimensions": DIMENSIONS, "seed": SEED},
    names=MATRIX,
)(neighbour_embedding)

register(
    "embedding",
    "umap",
    options={"dimensions": DIMENSIONS, "seed": SEED},
    names=MATRIX,
)(manifold_embedding)
