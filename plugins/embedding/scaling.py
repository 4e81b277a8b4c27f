"""Embeddings of a collection in the plane or in space."""

from typing import Annotated

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.statistics.distance_matrix import DistanceMatrix
from surfexp.statistics.multidimensional_scaling import (
    classical_scaling,
    manifold_embedding,
    neighbour_embedding,
    principal_components,
    stress_majorisation,
)
from surfexp.statistics.point_embedding import PointEmbedding

Dimensions = Annotated[int, Field(ge=1, le=50, description="dimension of the embedding")]
Seed = Annotated[int, Field(ge=0, description="seed of the random starts")]


METRICS = {
    "explained": Metric("share of the positive spectrum that is shown", better="higher"),
    "negative_share": Metric("share of negative eigenvalues", better="lower"),
}


@register("embedding", "classical", metrics=METRICS, defaults_of=classical_scaling)
def classical_embedding(distance_matrix: DistanceMatrix, *, dimensions: Dimensions) -> PointEmbedding:
    """Classical multidimensional scaling, deterministic, the default."""
    return classical_scaling(distance_matrix, dimensions)


@register("embedding", "smacof", metrics={"starts": Metric("starting configurations")}, defaults_of=stress_majorisation)
def smacof_embedding(distance_matrix: DistanceMatrix, *, dimensions: Dimensions, seed: Seed) -> PointEmbedding:
    """Multidimensional scaling of least stress by majorisation, from seeded starts."""
    return stress_majorisation(distance_matrix, dimensions, seed)


@register(
    "embedding",
    "pca",
    metrics={"explained": Metric("share of the variance that is shown", better="higher")},
    defaults_of=principal_components,
)
def pca_embedding(distance_matrix: DistanceMatrix, *, dimensions: Dimensions) -> PointEmbedding:
    """Principal components of the weighted signatures themselves."""
    return principal_components(distance_matrix, dimensions)


@register("embedding", "tsne", defaults_of=neighbour_embedding)
def tsne_embedding(distance_matrix: DistanceMatrix, *, dimensions: Dimensions, seed: Seed) -> PointEmbedding:
    """Neighbour embedding t-SNE, which keeps neighbours but no distances."""
    return neighbour_embedding(distance_matrix, dimensions, seed)


@register("embedding", "umap", defaults_of=manifold_embedding)
def umap_embedding(distance_matrix: DistanceMatrix, *, dimensions: Dimensions, seed: Seed) -> PointEmbedding:
    """Neighbour embedding UMAP, where umap-learn is installed; keeps neighbourhoods but no distances."""
    return manifold_embedding(distance_matrix, dimensions, seed)
