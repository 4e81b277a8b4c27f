"""The spectral distance of two surfaces with simple eigenvalues: minimised over signs, with its certificate."""

from __future__ import annotations

from typing import Literal

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.embedding.distance import Distance
from surfexp.embedding.mean_hausdorff import Direction, HausdorffObjective, Summary, Undecided
from surfexp.embedding.nearest import nearest
from surfexp.embedding.sign_search import LARGEST_ENUMERATION, Progress, Signs, SignSearch, greedy_signs, search_signs
from surfexp.embedding.spectral_embedding import SpectralEmbedding

Reading = Literal["inf_of_max", "max_of_inf"]
READINGS: dict[str, tuple[Direction, ...]] = {"inf_of_max": ("both",), "max_of_inf": ("forward", "backward")}
SAMPLED_LIMIT = 1000


def spectral_distance(
    source: SpectralEmbedding,
    target: SpectralEmbedding,
    reading: Reading = "inf_of_max",
    summary: Summary = "mean",
    undecided: Undecided = "absolute",
    samples: int = 1500,
    limit: int = 2000,
    seed: int = 0,
    exact: bool = True,
    progress: Progress | None = None,
) -> Distance:
    """Return d_n of (6.17), minimised over the signs of the target's eigenfunctions.

    Parameters
    ----------
    source, target : SpectralEmbedding
        Of the same n and weighting.
    reading : "inf_of_max" or "max_of_inf"
        (6.16) as published is max_of_inf, whose two infima may be attained by different signs, so that "the" optimal basis is
        not defined; inf_of_max takes one choice for both directions, and its signs are the optimal basis.
    summary : "mean" or "largest"
        Mean over the area as published in (6.7), which breaks the triangle inequality, or the Hausdorff distance.
    undecided : "absolute" or "prefix"
        The bound of the search, see `HausdorffObjective`.
    samples : int
        Number of points, drawn by area, on which the search starts.
    limit : int
        Most evaluations on all points; with fewer than the proof needs, the gap is returned, not hidden.
    exact : bool
        Search on all points; else take the signs that are best on the samples, unproved, and the value at all points.
    progress : callable, optional
        Called with the number of evaluations on all points and the relative gap.

    Raises
    ------
    ValueError
        If the embeddings differ in n or weighting, or an option is unknown.
    """
    if reading not in READINGS:
        raise ValueError(f"reading {reading!r} is unknown, choose one of {', '.join(READINGS)}")
    searches, notes = [], []
    for direction in READINGS[reading]:
        objective = HausdorffObjective(source, target, direction, summary, undecided, seed)
        draws, most = (1, min(limit, SAMPLED_LIMIT)) if exact else (2, SAMPLED_LIMIT)
        start, agreed, spent = sampled_signs(source, target, direction, summary, samples, seed, draws, most)
        if exact:
            searches.append(search_signs(objective, source.dimension, start, limit, progress))
        else:
            searches.append(_unproved(objective, start, spent))
        notes += [] if agreed else ["Two draws of samples prefer different signs: search exactly."]
    if exact and not all(search.optimal for search in searches):
        notes += [f"The search was stopped after {limit} evaluations: the value is the best found, not proved least."]
    method = f"{'mean Hausdorff' if summary == 'mean' else 'Hausdorff'}, {reading.replace('_', ' ')}"
    return _distance(source, target, searches, method, notes)


def _distance(
    source: SpectralEmbedding, target: SpectralEmbedding, searches: list[SignSearch], method: str, notes: list[str]
) -> Distance:
    """Return the largest of the values found, with the basis and the correspondence of its signs."""
    chosen = max(searches, key=lambda search: search.value)
    signs = chosen.signs.astype(np.float64)
    moved = target.points * signs
    rows, backward = nearest(moved, source.points)
    return Distance(
        value=chosen.value,
        lower_bound=max(search.lower_bound for search in searches),
        optimal=all(search.optimal for search in searches),
        evaluations=sum(search.evaluations for search in searches),
        basis=np.diag(signs),
        source_points=source.points,
        target_points=moved,
        correspondence=rows,
        closed=chosen.closed.astype(np.int64),
        bounds=chosen.bounds,
        method=method,
        metrics=_directions(source, target, nearest(source.points, moved)[1], backward, searches),
        notes=tuple(dict.fromkeys(notes)),
    )


def _directions(
    source: SpectralEmbedding,
    target: SpectralEmbedding,
    forward: Floats,
    backward: Floats,
    searches: list[SignSearch],
) -> dict[str, float]:
    """Mean distance from each surface to the other, the largest, and whether all searches found the same signs."""
    return {
        "forward": float(forward @ source.weights),
        "backward": float(backward @ target.weights),
        "hausdorff": float(max(forward.max(), backward.max())),
        "same_signs": float(all((search.signs == searches[0].signs).all() for search in searches)),
    }


def _unproved(objective: HausdorffObjective, signs: Signs, evaluations: int) -> SignSearch:
    """Return given signs with their value on all points; the bound is that of no sign decided."""
    node = np.zeros((1, len(signs)), np.int8)
    value, bound = objective(signs), objective.lower_bound(node[0])
    return SignSearch(signs, value, min(bound, value), bound >= value, evaluations, node, np.array([bound]))


def sampled_signs(
    source: SpectralEmbedding,
    target: SpectralEmbedding,
    direction: Direction = "both",
    summary: Summary = "mean",
    samples: int = 1500,
    seed: int = 0,
    draws: int = 2,
    limit: int = SAMPLED_LIMIT,
) -> tuple[Signs, bool, int]:
    """Return the best signs on samples, whether all draws of samples agree, and the number of evaluations."""
    found: list[SignSearch] = []
    start, spent = None, 0
    for draw in range(draws * seed, draws * (seed + 1)):
        pair = source.sample(samples, draw), target.sample(samples, draw)
        objective = HausdorffObjective(*pair, direction, summary, seed=seed)
        if start is None and source.dimension > LARGEST_ENUMERATION:
            start, spent = greedy_signs(objective.lower_bound, source.dimension)
        found.append(search_signs(objective, source.dimension, start, limit))
        start = found[0].signs
    agreed = all(bool((search.signs == found[0].signs).all()) for search in found)
    return found[0].signs, agreed, spent + sum(search.evaluations for search in found)
