"""Embeddings of a collection: classical scaling, stress majorisation, principal components, neighbours."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.extras import require_installed
from surfexp.statistics.distance_matrix import DistanceMatrix
from surfexp.statistics.point_embedding import PointEmbedding
from surfexp.statistics.signature_distances import euclidean

STARTS, SWEEPS, STRESS_TOLERANCE = 8, 2000, 1e-11


def classical_scaling(matrix: DistanceMatrix, dimensions: int = 2) -> PointEmbedding:
    """Embed by the largest eigenvalues of -J D^2 J / 2 (Torgerson 1952).

    Returns
    -------
    PointEmbedding
        Metrics: stress, explained (share of the positive eigenvalues that the dimensions hold), negative_share (sum of
        the negative eigenvalues over that of all in modulus; 0 for Euclidean distances).
    """
    _check(matrix, dimensions)
    n = len(matrix.labels)
    centring = np.eye(n) - 1.0 / n
    values, vectors = np.linalg.eigh(-0.5 * centring @ matrix.values**2 @ centring)
    values, vectors = values[::-1], vectors[:, ::-1]
    points = fixed_signs(vectors[:, :dimensions] * np.sqrt(np.maximum(values[:dimensions], 0.0)))
    total = float(np.abs(values).sum()) or 1.0
    positive = float(values[values > 0].sum()) or 1.0
    negative = float(np.abs(values[values < -1e-10 * total]).sum())
    metrics = {"explained": float(values[:dimensions].clip(0).sum()) / positive, "negative_share": negative / total}
    return _embedding(matrix, points, "classical scaling", metrics)


def principal_components(matrix: DistanceMatrix, dimensions: int = 2) -> PointEmbedding:
    """Project the coordinates of the collection on their principal axes.

    Raises
    ------
    ValueError
        If the matrix has no coordinates.
    """
    _check(matrix, dimensions)
    if matrix.coordinates is None:
        raise ValueError(f"the distances {matrix.name!r} come without coordinates, take classical MDS")
    centred = matrix.coordinates - matrix.coordinates.mean(axis=0)
    left, sizes, _ = np.linalg.svd(centred, full_matrices=False)
    kept = min(dimensions, len(sizes))
    points = np.zeros((len(centred), dimensions))
    points[:, :kept] = fixed_signs(left[:, :kept] * sizes[:kept])
    total = float((sizes**2).sum()) or 1.0
    return _embedding(
        matrix, points, "principal components", {"explained": float((sizes[:dimensions] ** 2).sum()) / total}
    )


def stress_majorisation(matrix: DistanceMatrix, dimensions: int = 2, seed: int = 0) -> PointEmbedding:
    """Minimise sum (D - d)^2 by scikit-learn's SMACOF (de Leeuw 1977), from the classical embedding and random starts."""
    from sklearn.manifold import smacof

    first = classical_scaling(matrix, dimensions).points
    settings = {"n_components": dimensions, "max_iter": SWEEPS, "eps": STRESS_TOLERANCE}
    candidates = [first]
    if matrix.values.any():  # scikit-learn divides by their squares
        candidates = [smacof(matrix.values, init=first, n_init=1, **settings)[0]]
        candidates += [smacof(matrix.values, n_init=STARTS - 1, random_state=seed, **settings)[0]]
    best = min(candidates, key=lambda points: round(stress(matrix.values, points), 9))
    centred = best - best.mean(axis=0)
    # principal axes make the result independent of the rotation of the start
    axes = np.linalg.svd(centred, full_matrices=False)[2]
    return _embedding(matrix, fixed_signs(centred @ axes.T), "stress majorisation", {"starts": float(STARTS)})


def neighbour_embedding(matrix: DistanceMatrix, dimensions: int = 2, seed: int = 0) -> PointEmbedding:
    """Embed by scikit-learn's t-SNE, which keeps neighbours and no distances."""
    from sklearn.manifold import TSNE

    _check(matrix, dimensions)
    perplexity = min(30.0, max(2.0, (len(matrix.labels) - 1) / 3.0))
    method = TSNE(
        dimensions, perplexity=perplexity, metric="precomputed", init="random", random_state=seed, method="exact"
    )
    return _embedding(matrix, np.asarray(method.fit_transform(matrix.values), dtype=np.float64), "t-SNE", {})


def manifold_embedding(matrix: DistanceMatrix, dimensions: int = 2, seed: int = 0) -> PointEmbedding:
    """Embed by UMAP (McInnes, Healy and Melville 2018), which keeps neighbourhoods and no distances; needs umap-learn.

    Raises
    ------
    ImportError
        If umap-learn is not installed.
    """
    _check(matrix, dimensions)
    require_installed("umap", "umap")
    umap: Any = import_module("umap")
    neighbours = max(2, min(15, len(matrix.labels) - 1))
    method = umap.UMAP(
        neighbours, dimensions, metric="precomputed", init="random", random_state=seed, n_jobs=1, low_memory=False
    )
    return _embedding(matrix, np.asarray(method.fit_transform(matrix.values), dtype=np.float64), "UMAP", {})


def stress(distances: Floats, points: Floats) -> float:
    """Return Kruskal's stress-1, sqrt(sum (D - d)^2 / sum D^2)."""
    total = float((distances**2).sum())
    return float(np.sqrt(((distances - euclidean(points)) ** 2).sum() / total)) if total > 0 else 0.0


def fixed_signs(points: Floats) -> Floats:
    """Flip axes so that the entry of largest modulus is positive (the first of them, to rounding)."""
    sizes = np.abs(points)
    at = np.argmax(sizes >= (1.0 - 1e-6) * sizes.max(axis=0), axis=0)
    return np.asarray(points * np.where(points[at, np.arange(points.shape[1])] < 0, -1.0, 1.0))


def _embedding(matrix: DistanceMatrix, points: Floats, method: str, metrics: dict[str, float]) -> PointEmbedding:
    metrics = {"stress": stress(matrix.values, points), **metrics}
    return PointEmbedding(
        points, matrix.labels, matrix.classes, matrix.groups, method, matrix.name, metrics, matrix.notes
    )


def _check(matrix: DistanceMatrix, dimensions: int) -> None:
    if not 1 <= dimensions <= len(matrix.labels) - 1:
        raise ValueError(f"{len(matrix.labels)} members in {dimensions} dimensions: take 1 to {len(matrix.labels) - 1}")
