"""Embeddings of a collection in the plane or in space."""

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.statistics.distance_matrix import DistanceMatrix
from surfexp.statistics.multidimensional_scaling import (
    classical_scaling,
    manifold_embedding,
    neighbour_embedding,
    principal_components,
    stress_majorisation,
)
from surfexp.statistics.point_embedding import PointEmbedding


class Scaling(Options):
    """The dimension."""

    dimensions: int = Field(2, ge=1, le=50, description="dimension of the embedding")


class Seeded(Scaling):
    """The dimension and the random start."""

    seed: int = Field(0, ge=0, description="seed of the random starts")


METRICS = {
    "explained": Metric("share of the positive spectrum that is shown", better="higher"),
    "negative_share": Metric("share of negative eigenvalues", better="lower"),
}


@register("embedding", "classical", metrics=METRICS)
def classical_embedding(options: Scaling, *, distance_matrix: DistanceMatrix) -> PointEmbedding:
    """Classical multidimensional scaling, deterministic, the default."""
    return classical_scaling(distance_matrix, options.dimensions)


@register("embedding", "smacof", metrics={"starts": Metric("starting configurations")})
def smacof_embedding(options: Seeded, *, distance_matrix: DistanceMatrix) -> PointEmbedding:
    """Multidimensional scaling of least stress by majorisation, from seeded starts."""
    return stress_majorisation(distance_matrix, options.dimensions, options.seed)


@register("embedding", "pca", metrics={"explained": Metric("share of the variance that is shown", better="higher")})
def pca_embedding(options: Scaling, *, distance_matrix: DistanceMatrix) -> PointEmbedding:
    """Principal components of the weighted signatures themselves."""
    return principal_components(distance_matrix, options.dimensions)


@register("embedding", "tsne")
def tsne_embedding(options: Seeded, *, distance_matrix: DistanceMatrix) -> PointEmbedding:
    """Neighbour embedding t-SNE, which keeps neighbours but no distances."""
    return neighbour_embedding(distance_matrix, options.dimensions, options.seed)


@register("embedding", "umap")
def umap_embedding(options: Seeded, *, distance_matrix: DistanceMatrix) -> PointEmbedding:
    """Neighbour embedding UMAP, where umap-learn is installed; keeps neighbourhoods but no distances."""
    return manifold_embedding(distance_matrix, options.dimensions, options.seed)
