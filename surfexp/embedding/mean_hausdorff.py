"""The mean Hausdorff distance (6.7) between two embeddings as a function of signs, with bounds where some are undecided."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.embedding.nearest import BLOCK, mutual_distances, rounding_error
from surfexp.embedding.sign_search import Signs
from surfexp.embedding.spectral_embedding import SpectralEmbedding, check_pair

Direction = Literal["forward", "backward", "both"]
Summary = Literal["mean", "largest"]
Undecided = Literal["absolute", "prefix"]


class HausdorffObjective:
    """Distance of the source to the target under signs of the target, for `branch_and_bound`.

    On decided coordinates points are compared as they are. On the others their absolute values are, which is the least
    that any signs can give ("absolute"), or nothing is ("prefix").

    Parameters
    ----------
    source, target : SpectralEmbedding
    direction : "forward", "backward" or "both"
        Source to target, target to source, or the larger of the two.
    summary : "mean" or "largest"
        Area-weighted mean over the points, as published in (6.7), or the largest: the Hausdorff distance, a metric.
    undecided : "absolute" or "prefix"
    seed : int
        Of the order in which points are visited.
    """

    def __init__(
        self,
        source: SpectralEmbedding,
        target: SpectralEmbedding,
        direction: Direction = "both",
        summary: Summary = "mean",
        undecided: Undecided = "absolute",
        seed: int = 0,
    ) -> None:
        check_pair(source, target)
        if direction == "backward":
            source, target = target, source
        self.n, self.undecided, self.both = source.dimension, undecided, direction == "both"
        order = np.random.default_rng(seed).permutation(len(source.points))
        self.source, self.target = source.points[order], target.points
        self.source_weights, self.target_weights = source.weights[order], target.weights
        self.summarise: Callable[[Floats, Floats], float] = _mean if summary == "mean" else _largest
        self._absolute = np.abs(self.source), np.abs(self.target)

    def __call__(self, signs: Signs, cutoff: float = np.inf) -> float:
        """Return the objective, or a lower bound of it; see `branch_and_bound`."""
        source, target = self._arranged(signs)
        if np.isfinite(cutoff) and source.shape[1] > 2:
            bound = self._single_precision(source, target, cutoff)
            if bound > cutoff:
                return bound
        forward, backward = mutual_distances(source, target)
        value = self.summarise(forward, self.source_weights)
        return max(value, self.summarise(backward, self.target_weights)) if self.both else value

    def lower_bound(self, signs: Signs, cutoff: float = np.inf) -> float:
        """Return a bound that no completion of the signs undercuts, in single precision with its rounding taken off."""
        return self._single_precision(*self._arranged(signs), cutoff)

    def _arranged(self, signs: Signs) -> tuple[Floats, Floats]:
        known = int((signs != 0).sum())
        if self.undecided == "prefix" and known < self.n:
            return self.source[:, :known] * signs[:known], self.target[:, :known]
        source, target = (
            np.hstack([points[:, :known], absolute[:, known:]])
            for points, absolute in zip((self.source, self.target), self._absolute, strict=True)
        )
        source[:, :known] *= signs[:known]
        return source, target

    def _single_precision(self, source: Floats, target: Floats, cutoff: float) -> float:
        """A lower bound by products in single precision less their largest rounding error, given up above the cutoff."""
        own, norms = (source**2).sum(axis=1), (target**2).sum(axis=1)
        slack = rounding_error(source.shape[1], own, float(norms.max()))
        left = np.hstack([source, np.ones((len(source), 1))]).astype(np.float32)
        right = np.hstack([-2.0 * target, norms[:, None]]).T.astype(np.float32)
        backward = np.full(len(target), np.inf, np.float32)
        forward = np.zeros(len(source))
        for start in range(0, len(source), BLOCK):
            some = slice(start, start + BLOCK)
            squares = left[some] @ right
            forward[some] = np.sqrt(np.maximum(squares.min(axis=1) + own[some] - slack[some], 0.0))
            if self.both:
                squares += own[some, None].astype(np.float32)
                np.minimum(backward, squares.min(axis=0), out=backward)
            bound = self.summarise(forward, self.source_weights)
            if bound > cutoff:
                return bound
        if not self.both:
            return bound
        nearest = np.sqrt(np.maximum(backward - slack.max(), 0.0))
        return max(bound, self.summarise(nearest, self.target_weights))


def summarised(
    forward: Floats,
    backward: Floats,
    source: SpectralEmbedding,
    target: SpectralEmbedding,
    direction: Direction,
    summary: Summary,
) -> float:
    """Return the objective from the distance of each source point to the target, and of each target point back."""
    summarise = _mean if summary == "mean" else _largest
    there, back = summarise(forward, source.weights), summarise(backward, target.weights)
    return {"forward": there, "backward": back, "both": max(there, back)}[direction]


def _mean(distances: Floats, weights: Floats) -> float:
    return float(distances @ weights)


def _largest(distances: Floats, weights: Floats) -> float:
    return float(distances.max())
