"""Which people a descriptor recognises under which change, how reliable its entries are, and what the certificate changes."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy.spatial.distance import cdist, pdist

from surfexp.contract.arrays import Floats
from surfexp.contract.member import Member
from surfexp.spectrum.signature import Signature
from surfexp.statistics.resampling import exact_interval
from surfexp.statistics.statistic import Statistic

from .certificate import share_beyond
from .descriptors import BOUNDED, RADII, USUAL
from .recognition import Person, Recognition, by_change, donors_of, recognition
from .reliability import constant_entries, median_reliability, reliability_within


def identification(signatures: Mapping[Member, Signature], part: str, alpha: float = 1.0) -> Statistic:
    """Identify everybody seen again among all originals.

    Parameters
    ----------
    signatures : mapping of Member to Signature
        Of `fingerprint`; class: the change, one of them "original"; group: the donor; level: the number of the person.
    part : str
        Which descriptor.
    alpha : float
        Entry n is divided by n^alpha, (4.3).

    Returns
    -------
    Statistic
        Rows: the changes, and all. Columns: rank_one with the interval of Clopper and Pearson; rank_one_by_donor with
        that of a bootstrap over donors; donor, the share whose donor is recognised; icc, the median over entries of
        ICC(2,1) of original and change (in the last row of all), with its bootstrap interval; icc_within, among the
        people of one donor; rank_one_centred, the share recognised when the mean over people is taken off originals
        and each change, so that a shift that all people share does not count.

    Raises
    ------
    ValueError
        If people or changes are missing, or there is no such part.
    """
    seen = by_change(signatures)
    donors = donors_of(seen["original"])
    tables = {change: _table(found, part) for change, found in seen.items()}
    scale = np.arange(1.0, tables["original"].shape[1] + 1.0) ** -alpha
    answers = _answers(tables, scale, donors)
    centred = _answers({change: table - table.mean(axis=0) for change, table in tables.items()}, scale, donors)
    rows = [
        _row(answer, np.stack([tables["original"], tables[change]], axis=1), donors)
        for change, answer in answers.items()
    ]
    everything = np.stack(list(tables.values()), axis=1)
    right = np.concatenate([answer.right for answer in answers.values()])
    donor = float(np.mean([answer.donor_right() for answer in answers.values()]))
    total = (float(right.mean()), *exact_interval(int(right.sum()), len(right)))
    within = reliability_within(everything, donors)
    rows.append((total, _all_by_donor(answers), donor, median_reliability(everything, donors), within))
    names = ("rank_one", "rank_one_by_donor", "donor", "icc", "icc_within")
    columns = {name: np.array([row[k] for row in rows], dtype=np.float64) for k, name in enumerate(names)}
    shares = [float(answer.right.mean()) for answer in centred.values()]
    columns["rank_one_centred"] = np.array([*shares, np.mean(shares)])
    metrics = {"people": float(len(donors)), "constant_entries": float(constant_entries(everything))}
    for change, share in zip((*answers, ""), columns["rank_one"].tolist(), strict=True):
        suffix = f" {change}" if change else ""
        metrics |= {
            f"rank_one{suffix}": share[0],
            f"rank_one_low{suffix}": share[1],
            f"rank_one_high{suffix}": share[2],
        }
    metrics["centred_rank_one"] = float(np.mean(shares))
    metrics |= {f"centred_rank_one {change}": share for change, share in zip(answers, shares, strict=True)}
    for name in ("icc", "icc_within"):
        last = np.atleast_1d(columns[name][-1])
        metrics |= {name: float(last[0])} if np.isfinite(last[0]) else {}
    metrics |= _without_certificate(seen, tables, answers, part, scale, donors)
    return Statistic(f"identification by {part.replace('_', ' ')}", columns, (*answers, "all"), metrics)


def _table(found: Mapping[Person, Signature], part: str) -> Floats:
    return np.stack([signature.part(part) for signature in found.values()])


def _answers(tables: Mapping[str, Floats], scale: Floats, donors: tuple[str, ...]) -> dict[str, Recognition]:
    gallery = scale * tables["original"]
    return {
        change: recognition(cdist(scale * table, gallery), donors)
        for change, table in tables.items()
        if change != "original"
    }


def _row(answer: Recognition, ratings: Floats, donors: tuple[str, ...]) -> tuple[object, ...]:
    reliability = median_reliability(ratings, donors), reliability_within(ratings, donors)
    return (answer.rank_one(), answer.by_donor(), answer.donor_right(), *reliability)


def _all_by_donor(answers: Mapping[str, Recognition]) -> tuple[float, float, float]:
    """Over all changes at once; the queries of a donor belong together."""
    count = len(next(iter(answers.values())).nearest)
    shifted = [
        answer.nearest + np.where(answer.nearest >= 0, k * count, 0) for k, answer in enumerate(answers.values())
    ]
    return Recognition(
        np.concatenate(shifted), np.concatenate([answer.donors for answer in answers.values()])
    ).by_donor()


def _without_certificate(
    seen: Mapping[str, Mapping[Person, Signature]],
    tables: Mapping[str, Floats],
    answers: Mapping[str, Recognition],
    part: str,
    scale: Floats,
    donors: tuple[str, ...],
) -> dict[str, float]:
    """What is different with the spectra of the usual solver."""
    usual = {change: _table(found, USUAL + part) for change, found in seen.items()}
    others = _answers(usual, scale, donors)
    changed = sum(int((others[change].nearest != answer.nearest).sum()) for change, answer in answers.items())
    first, second = (np.concatenate(list(found.values())) for found in (tables, usual))
    moved = float(np.linalg.norm(scale * (first - second), axis=1).max())
    apart = float(pdist(scale * tables["original"]).min())
    metrics = {
        "descriptors": float(len(first)),
        "answers_changed": float(changed),
        "usual_rank_one": float(np.mean([answer.right.mean() for answer in others.values()])),
        "usual_shift": moved / apart if apart > 0 else float(moved > 0),
    }
    if part in BOUNDED:
        radii, other_radii = (
            np.concatenate([_table(found, RADII + route + part) for found in seen.values()]) for route in ("", USUAL)
        )
        metrics["beyond_certificate"] = float(share_beyond(first, second, radii, other_radii).mean())
        metrics["largest_certificate"] = float((radii / np.abs(first)).max())
    return metrics
