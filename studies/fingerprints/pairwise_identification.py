"""Rank-one identification by distances that align the eigenfunctions of two surfaces."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from surfexp.contract.member import Member
from surfexp.embedding.distance_methods import Pairing
from surfexp.embedding.spectral_embedding import SpectralEmbedding
from surfexp.statistics.resampling import exact_interval
from surfexp.statistics.statistic import Statistic

from .recognition import by_change, donors_of, recognition


def pairwise_identification(embeddings: Mapping[Member, SpectralEmbedding], pairing: Pairing) -> Statistic:
    """Identify everybody seen again among all originals by a distance of pairs.

    Parameters
    ----------
    embeddings : mapping of Member to SpectralEmbedding
        Class: the change, one of them "original"; group: the donor; level: the number of the person.
    pairing : Pairing

    Returns
    -------
    Statistic
        Rows: the changes, and all. Columns: rank_one with the interval of Clopper and Pearson; donor, the share whose
        donor is recognised. `proved` is the share of distances that are proved least.
    """
    seen = by_change(embeddings)
    donors = donors_of(seen["original"])
    gallery = list(seen["original"].values())
    answers, closed = {}, []
    for change, found in seen.items():
        if change == "original":
            continue
        pairs = np.array([[pairing(query, known) for known in gallery] for query in found.values()])
        answers[change] = recognition(pairs[..., 0], donors)
        closed.append(pairs[..., 1] >= pairs[..., 0])
    right = np.concatenate([answer.right for answer in answers.values()])
    total = (float(right.mean()), *exact_interval(int(right.sum()), len(right)))
    shares = np.array([*(answer.rank_one() for answer in answers.values()), total])
    donor = [answer.donor_right() for answer in answers.values()]
    metrics = {"people": float(len(donors)), "pairs": float(np.size(closed)), "proved": float(np.mean(closed))}
    for change, (share, low, high) in zip((*answers, ""), shares.tolist(), strict=True):
        suffix = f" {change}" if change else ""
        metrics |= {f"rank_one{suffix}": share, f"rank_one_low{suffix}": low, f"rank_one_high{suffix}": high}
    columns = {"rank_one": shares, "donor": np.array([*donor, np.mean(donor)])}
    return Statistic(f"identification by {pairing.method.replace('_', ' ')}", columns, (*answers, "all"), metrics)
