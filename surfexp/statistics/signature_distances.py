"""Distances between the signatures of a collection."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.contract.member import Member
from surfexp.spectrum.signature import Signature
from surfexp.statistics.distance_matrix import DistanceMatrix
from surfexp.statistics.separation import separation

# parts of a spectral signature as captions call them
WORDS = {
    "shape_dna": "shape DNA, times area",
    "shape_dna_raw": "shape DNA, raw",
    "shape_dna_reweighted": "shape DNA, reweighted",
    "nodal_counts": "nodal counts, filtered",
    "nodal_raw": "nodal counts, published",
    "nodal_soft": "nodal counts, soft",
    "combined": "spectrum and counts combined",
    "hks": "heat kernel signature",
    "wks": "wave kernel signature",
    "gps": "global point signature",
}


def signature_distances(
    signatures: Mapping[Member, Signature], part: str = "", alpha: float = 1.0, length: int | None = None
) -> DistanceMatrix:
    """Return sqrt(sum_n ((l_n - l'_n) / n^alpha)^2) (4.3) between all members; alpha = 0 is the Euclidean distance.

    Parameters
    ----------
    signatures : mapping of Member to Signature
    part : str
        Which part of the signatures; empty: the signature itself.
    alpha : float
    length : int, optional
        N: how many entries; default: as many as the shortest signature has.

    Returns
    -------
    DistanceMatrix
        `coordinates` are l_n / n^alpha: the distances are Euclidean ones of these points.

    Raises
    ------
    ValueError
        If there are fewer than two members, one is not finite, or one is shorter than `length`.
    """
    labels, rows = (
        tuple(member.label for member in signatures),
        [signature.part(part) for signature in signatures.values()],
    )
    if len(rows) < 2:
        raise ValueError(f"the collection has {len(rows)} members, distances need at least 2")
    shortest = min(len(row) for row in rows)
    if length is not None and length > shortest:
        short = labels[int(np.argmin([len(row) for row in rows]))]
        raise ValueError(f"length = {length}, but {short!r} has {shortest} entries: take length <= {shortest}")
    used = length or shortest
    values = np.stack([row[:used] for row in rows])
    bad = np.flatnonzero(~np.isfinite(values).all(axis=1))
    if len(bad):
        raise ValueError(f"the signature of {labels[bad[0]]!r} is not finite, and {len(bad) - 1} others")
    name = WORDS.get(part) or (part or next(iter(signatures.values())).name).replace("_", " ")
    points = values * np.arange(1.0, used + 1.0) ** -alpha
    distances = euclidean(points)
    classes, groups = zip(*((member.class_name, member.group) for member in signatures), strict=True)
    metrics = {"members": float(len(labels)), "length": float(used), **separation(distances, classes)}
    notes: tuple[str, ...] = ()
    longest = max(len(row) for row in rows)
    if length is None and longest > shortest:
        notes = (f"Signatures have {shortest} to {longest} entries; the first {shortest} are compared.",)
    return DistanceMatrix(labels, distances, classes, groups, points, name=name, metrics=metrics, notes=notes)


def euclidean(points: Floats) -> Floats:
    """(n, n) distances between points, exactly symmetric."""
    from scipy.spatial.distance import pdist, squareform

    return np.asarray(squareform(pdist(points)))
