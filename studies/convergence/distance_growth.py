"""How the spectral distance d_n and the norm of the embedding grow with the number n of eigenfunctions."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.embedding.eigenvalue_blocks import eigenvalue_blocks
from surfexp.embedding.nearest import mutual_distances
from surfexp.embedding.spectral_embedding import SpectralEmbedding, check_pair


def squared_norms(embedding: SpectralEmbedding, sizes: Sequence[int]) -> Floats:
    """Return the mean squared norm of the first n coordinates for each n, sum 1 / lambda_i for global points."""
    squares = embedding.weights @ embedding.points**2
    return np.array([float(squares[:n].sum()) for n in sizes])


def logarithmic_slope(sizes: Sequence[int], values: Floats) -> float:
    """Return the slope b of the least-squares line a + b ln n."""
    return float(np.polyfit(np.log(np.asarray(sizes, float)), values, 1)[0])


def distance_brackets(
    source: SpectralEmbedding, target: SpectralEmbedding, sizes: Sequence[int], gap: float = 1e-6
) -> tuple[Floats, Floats]:
    """Return lower and upper bounds of the mean Hausdorff distance d_n, least over signs and exact multiplicities.

    The upper one is taken in the bases given. The lower one compares, within each eigenspace of either surface, only the
    lengths of points, which no choice of a basis changes; at n that cut an eigenspace both refer to the first n functions.
    """
    check_pair(source, target)
    lower, upper = [], []
    for n in sizes:
        first, second = source.truncated(n), target.truncated(n)
        upper.append(_mean_hausdorff(first.points, second.points, first.weights, second.weights))
        blocks = eigenvalue_blocks(first.values, second.values, gap=gap)
        lengths = [
            np.stack([np.linalg.norm(e.points[:, start:stop], axis=1) for start, stop in blocks], axis=1)
            for e in (first, second)
        ]
        lower.append(_mean_hausdorff(lengths[0], lengths[1], first.weights, second.weights))
    return np.array(lower), np.array(upper)


def _mean_hausdorff(first: Floats, second: Floats, first_weights: Floats, second_weights: Floats) -> float:
    forward, backward = mutual_distances(first, second)
    return max(float(forward @ first_weights), float(backward @ second_weights))
