"""How far classes lie apart in a matrix of distances, and how well it finds others of the same class."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from surfexp.contract.arrays import Floats


def separation(distances: Floats, classes: Sequence[str]) -> dict[str, float]:
    """Return between_within, the mean distance between classes over that inside them, and the mean silhouette.

    Empty where there is one class only, or one member in each. A member alone in its class has silhouette 0.
    """
    names, codes = np.unique(np.asarray(classes), return_inverse=True)
    same = codes[:, None] == codes[None, :]
    pairs = np.triu(np.ones_like(same), 1)
    if len(names) < 2 or not (same & pairs).any():
        return {}
    within, between = distances[same & pairs].mean(), distances[~same & pairs].mean()
    return {
        "between_within": float(between / within) if within > 0 else 0.0,
        "silhouette": float(silhouettes(distances, codes).mean()),
    }


def silhouettes(distances: Floats, codes: np.ndarray) -> Floats:
    """(n,) (b - a) / max(a, b), a the mean distance to the own class, b to the nearest other one (Rousseeuw 1987)."""
    members = np.eye(codes.max() + 1)[codes]
    sizes = members.sum(axis=0)
    sums = distances @ members
    here = np.arange(len(codes))
    own = sums[here, codes] / np.maximum(sizes[codes] - 1.0, 1.0)
    others = sums / sizes
    others[here, codes] = np.inf
    nearest = others.min(axis=1)
    largest = np.maximum(np.maximum(own, nearest), np.finfo(float).tiny)
    return np.where(sizes[codes] > 1, (nearest - own) / largest, 0.0)


def retrieval(distances: Floats, classes: Sequence[str], groups: Sequence[str] | None = None) -> dict[str, float]:
    """Return nearest_neighbour, first_tier, second_tier and mean_average_precision over all members as queries.

    With c others of the query's class, the tiers are the shares of these among the first c and 2 c answers. Members of the
    query's group are no answers, where groups are given. Queries without any other of their class are left out.

    Raises
    ------
    ValueError
        If no query has another member of its class.
    """
    classes_, n = np.asarray(classes), len(classes)
    owners = np.arange(n) if groups is None else np.unique(np.asarray(groups), return_inverse=True)[1]
    scores = []
    for query in range(n):
        others = np.flatnonzero(owners != owners[query])
        answers = others[np.argsort(distances[query, others], kind="stable")]
        relevant = classes_[answers] == classes_[query]
        count = int(relevant.sum())
        if not count:
            continue
        precision = np.cumsum(relevant) / np.arange(1.0, len(relevant) + 1.0)
        tiers = relevant[:count].sum() / count, relevant[: 2 * count].sum() / count
        scores.append((float(relevant[0]), *tiers, precision[relevant].mean()))
    if not scores:
        raise ValueError(f"none of {n} members has another one of its class: nothing can be retrieved")
    names = ("nearest_neighbour", "first_tier", "second_tier", "mean_average_precision")
    return dict(zip(names, (float(score) for score in np.mean(scores, axis=0)), strict=True))
