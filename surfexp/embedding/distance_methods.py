"""One number for a pair of embedded surfaces by a named method, for matrices of many pairs, and what a matrix obeys."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.embedding.block_alignment import block_distance
from surfexp.embedding.eigenvalue_blocks import eigenvalue_blocks
from surfexp.embedding.nearest import mutual_distances
from surfexp.embedding.spectral_distance import spectral_distance
from surfexp.embedding.spectral_embedding import SpectralEmbedding
from surfexp.embedding.sup_inf import block_group, sup_inf_distance
from surfexp.embedding.wasserstein import wasserstein_distance

Method = Literal[
    "mean_hausdorff", "hausdorff", "wasserstein", "block_orthogonal", "least_over_blocks", "sup_inf", "sup_inf_mean"
]


@dataclass(frozen=True)
class Pairing:
    """How pairs are compared.

    Parameters
    ----------
    method : str
        `mean_hausdorff`, `hausdorff`, `wasserstein` least over signs; `block_orthogonal` by alignment;
        `least_over_blocks` on a grid of bases; `sup_inf` (6.9) with the Hausdorff distance inside, `sup_inf_mean` as published.
    exact : bool
        Search signs on all points, with proof, or on samples.
    samples : int
        Points of each surface in searches; in transport and on grids of bases nothing else is compared.
    limit : int
        Most evaluations of a search for signs.
    gap : float
        Relative gap under which eigenvalues belong together.
    angles : int
        Bases of each plane on grids.
    seed : int
    """

    method: Method = "mean_hausdorff"
    exact: bool = True
    samples: int = 1500
    limit: int = 2000
    gap: float = 0.03
    angles: int = 24
    seed: int = 0

    def __call__(self, source: SpectralEmbedding, target: SpectralEmbedding) -> tuple[float, float]:
        """Return the distance and what no admissible basis can undercut, 0 where bases are tried on a grid."""
        if self.method in ("mean_hausdorff", "hausdorff"):
            summary: Literal["mean", "largest"] = "mean" if self.method == "mean_hausdorff" else "largest"
            found = spectral_distance(
                source,
                target,
                summary=summary,
                samples=self.samples,
                limit=self.limit,
                seed=self.seed,
                exact=self.exact,
            )
            return found.value, found.lower_bound
        if self.method == "wasserstein":
            found = wasserstein_distance(source, target, self.samples, self.limit, self.seed)
            return found.value, found.lower_bound
        own = [eigenvalue_blocks(embedding.values, gap=self.gap) for embedding in (source, target)]
        if self.method == "block_orthogonal":
            blocks = eigenvalue_blocks(source.values, target.values, gap=self.gap)
            return block_distance(source, target, blocks, samples=self.samples, seed=self.seed).value, 0.0
        few = source.sample(self.samples, self.seed), target.sample(self.samples, self.seed)
        if self.method == "least_over_blocks":
            coarse = min(own, key=len)
            return min(_mean_hausdorff(*few, basis) for basis in block_group(coarse, self.angles, self.seed)), 0.0
        inside: Literal["mean", "largest"] = "largest" if self.method == "sup_inf" else "mean"
        return sup_inf_distance(*few, own[0], own[1], inside, self.angles, self.seed), 0.0


def _mean_hausdorff(source: SpectralEmbedding, target: SpectralEmbedding, basis: Floats) -> float:
    forward, backward = mutual_distances(source.points, target.points @ basis)
    return max(float(forward @ source.weights), float(backward @ target.weights))


def pairwise_distances(embeddings: Mapping[str, SpectralEmbedding], pairing: Pairing) -> tuple[Floats, Floats]:
    """Return the symmetric (m, m) matrices of the distances of all pairs, and of their lower bounds."""
    members = list(embeddings.values())
    values, bounds = np.zeros((2, len(members), len(members)))
    for i in range(len(members)):
        for j in range(i):
            values[i, j], bounds[i, j] = pairing(members[i], members[j])
    return values + values.T, bounds + bounds.T


def gap_metrics(values: Floats, bounds: Floats) -> dict[str, float]:
    """Return the share of pairs proved least, and the mean and largest (value - bound) / value of all pairs."""
    rows = np.tril_indices(len(values), -1)
    value, bound = values[rows], bounds[rows]
    gaps = np.divide(value - bound, value, out=np.zeros(len(value)), where=value > bound)
    if not len(gaps):
        return {"proved": 1.0, "mean gap": 0.0, "largest gap": 0.0}
    return {"proved": float((gaps == 0.0).mean()), "mean gap": float(gaps.mean()), "largest gap": float(gaps.max())}


def unproved_pairs(labels: Sequence[str], values: Floats, bounds: Floats) -> tuple[str, ...]:
    """One sentence for each pair that is not proved least, with the bound and the gap."""
    return tuple(
        f"{labels[j]} to {labels[i]}: {values[i, j]:.4f} is the best found, at least {bounds[i, j]:.4f} is proved, a gap "
        f"of {100.0 * (1.0 - bounds[i, j] / values[i, j]):.2g} %."
        for i in range(len(labels))
        for j in range(i)
        if bounds[i, j] < values[i, j]
    )


def triangle_metrics(matrix: Floats) -> dict[str, float]:
    """Return the worst d(a, c) / (d(a, b) + d(b, c)) over triples, 1 at most for a metric, and the share above 1.

    A rounding of 1e-9 is allowed for; with fewer than three members both are 0.
    """
    count = len(matrix)
    ratios = []
    for middle in range(count):
        others = [k for k in range(count) if k != middle]
        for place, a in enumerate(others):
            for c in others[:place]:
                way = matrix[a, middle] + matrix[middle, c]
                ratios.append(matrix[a, c] / way if way > 0 else (np.inf if matrix[a, c] > 1e-12 else 0.0))
    if not ratios:
        return {"triangle_ratio": 0.0, "triangles_broken": 0.0}
    worst = min(float(np.max(ratios)), 1e9)
    return {"triangle_ratio": worst, "triangles_broken": float(np.mean(np.array(ratios) > 1.0 + 1e-9))}
