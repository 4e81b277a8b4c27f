"""The Wasserstein distance of the area measures of two embeddings, exact on samples, minimised over signs."""

from __future__ import annotations

from typing import Literal

import numpy as np
from scipy.spatial.distance import cdist

from surfexp.contract.arrays import Floats
from surfexp.embedding.distance import Distance
from surfexp.embedding.nearest import nearest
from surfexp.embedding.sign_search import Signs, search_signs
from surfexp.embedding.spectral_embedding import SpectralEmbedding, check_pair
from surfexp.extras import require_installed

Transport = Literal["exact", "sinkhorn"]


def transport_cost(
    first: Floats, second: Floats, weights: tuple[Floats, Floats], transport: Transport = "exact", entropy: float = 0.02
) -> float:
    """Return the least mean distance over which one measure can be carried to the other, W_1.

    Parameters
    ----------
    first, second : (p, n), (q, n) float64
    weights : tuple of (p,) and (q,) float64
        Each of sum 1.
    transport : "exact" or "sinkhorn"
        Network simplex, or entropic plans with the bias of either measure to itself taken off (not a bound).
    entropy : float
        Of Sinkhorn's plans, as a share of the mean distance.
    """
    require_installed("optimal transport", "ot")
    import ot

    if transport == "exact":
        return float(ot.emd2(*weights, cdist(first, second)))
    if transport != "sinkhorn":
        raise ValueError(f"transport {transport!r} is unknown, choose exact or sinkhorn")
    scale = entropy * float(cdist(first, second).mean())

    def plan_cost(x: Floats, y: Floats, a: Floats, b: Floats) -> float:
        cost = cdist(x, y)
        plan = ot.sinkhorn(a, b, cost, scale, method="sinkhorn_log", numItermax=2000, stopThr=1e-7, warn=False)
        return float((plan * cost).sum())

    a, b = weights
    between = plan_cost(first, second, a, b)
    return max(between - 0.5 * (plan_cost(first, first, a, a) + plan_cost(second, second, b, b)), 0.0)


class WassersteinObjective:
    """W_1 under signs of the target, for `branch_and_bound`: on undecided coordinates absolute values are compared."""

    def __init__(self, source: SpectralEmbedding, target: SpectralEmbedding) -> None:
        check_pair(source, target)
        self.source, self.target = source, target
        self._absolute = np.abs(source.points), np.abs(target.points)

    def __call__(self, signs: Signs, cutoff: float = np.inf) -> float:
        """Return W_1, or a lower bound of it where signs are undecided."""
        known = int((signs != 0).sum())
        first = np.hstack([self.source.points[:, :known] * signs[:known], self._absolute[0][:, known:]])
        second = np.hstack([self.target.points[:, :known], self._absolute[1][:, known:]])
        return transport_cost(first, second, (self.source.weights, self.target.weights))


def wasserstein_distance(
    source: SpectralEmbedding,
    target: SpectralEmbedding,
    samples: int = 200,
    limit: int = 2000,
    seed: int = 0,
    transport: Transport = "exact",
    entropy: float = 0.02,
) -> Distance:
    """Return W_1 between samples of the area measures, least over signs.

    The same seed draws the same samples of a surface in every pair, so between samples the triangle inequality holds.

    Parameters
    ----------
    samples : int
        Points of each surface, drawn by area.
    limit : int
        Most transport problems.
    transport, entropy
        As in `transport_cost`; the search over signs is exact in either case.
    """
    few = source.sample(samples, seed), target.sample(samples, seed)
    search = search_signs(WassersteinObjective(*few), source.dimension, None, limit)
    moved = target.points * search.signs
    value, lower, optimal = search.value, search.lower_bound, search.optimal
    if transport != "exact":
        weights = few[0].weights, few[1].weights
        value = transport_cost(few[0].points, few[1].points * search.signs, weights, transport, entropy)
        lower, optimal = 0.0, False
    return Distance(
        value=value,
        lower_bound=lower,
        optimal=optimal,
        evaluations=search.evaluations,
        basis=np.diag(search.signs.astype(np.float64)),
        source_points=source.points,
        target_points=moved,
        correspondence=nearest(moved, source.points)[0],
        closed=search.closed.astype(np.int64),
        bounds=search.bounds,
        method=f"Wasserstein, {transport}",
        metrics={"samples": float(min(samples, len(source.points)))},
    )
