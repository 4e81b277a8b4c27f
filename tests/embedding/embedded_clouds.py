"""Embeddings to compare."""

from __future__ import annotations

import numpy as np

from surfexp.embedding.spectral_embedding import SpectralEmbedding


def cloud(n: int, count: int, seed: int, symmetric: float = 0.0) -> SpectralEmbedding:
    """Random points whose spread falls like 1 / sqrt(k); `symmetric` is how near they are to their mirror images."""
    rng = np.random.default_rng(seed)
    half = rng.normal(size=(count // 2, n)) / np.sqrt(np.arange(1.0, n + 1.0))
    mirror = half * rng.choice([-1.0, 1.0], n) + (1.0 - symmetric) * rng.normal(size=half.shape) * 0.3
    weights = rng.uniform(0.5, 1.5, 2 * len(half))
    return SpectralEmbedding(np.vstack([half, mirror]), weights / weights.sum(), np.arange(1.0, n + 1.0) * 8.0)
