"""How far nodal counts repeat: agreement of count sequences of several meshes of one shape."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.spectrum.signature import Signature
from surfexp.statistics.statistic import Statistic

WINDOW = 20
TRUST = 0.9


def count_agreement(reference: Signature, others: Mapping[str, Signature], part: str = "") -> Statistic:
    """Compare nodal counts with those of a reference mesh, mode by mode.

    Parameters
    ----------
    reference : Signature
    others : mapping of label to Signature
        Of the same shape, meshed otherwise.
    part : str
        Part of all signatures.

    Returns
    -------
    Statistic
        Columns: mode, and for each other the share of equal counts among the 20 modes around it. Metrics for each:
        "first 20 LABEL", "all LABEL", "trusted LABEL" (the first mode at which the share falls under 0.9), and their
        means "first_20", "all", "trusted", "mean_error".

    Raises
    ------
    ValueError
        If there is nothing to compare, or fewer than 20 modes.
    """
    sequences = {label: np.round(signature.part(part)) for label, signature in others.items()}
    known = np.round(reference.part(part))
    length = min([len(known), *(len(sequence) for sequence in sequences.values())]) if sequences else 0
    if length < WINDOW:
        raise ValueError(f"{len(sequences)} sequences of {length} modes: at least 1 of {WINDOW} is needed")
    columns: dict[str, Floats] = {"mode": np.arange(1.0, length + 1.0)}
    metrics: dict[str, float] = {}
    errors: list[float] = []
    values: dict[str, list[float]] = {name: [] for name in ("first 20", "all", "trusted")}
    for label, sequence in sequences.items():
        same = sequence[:length] == known[:length]
        share = moving_mean(same.astype(np.float64))
        columns[label] = share
        low = np.flatnonzero(share < TRUST)
        numbers = {"first 20": same[:WINDOW].mean(), "all": same.mean(), "trusted": low[0] if len(low) else length}
        for name, number in numbers.items():
            metrics[f"{name} {label}"] = float(number)
            values[name].append(float(number))
        errors.append(float(np.abs(sequence[:length] - known[:length]).mean()))
    metrics |= {name.replace(" ", "_"): float(np.mean(numbers_of)) for name, numbers_of in values.items()}
    metrics["mean_error"] = float(np.mean(errors))
    return Statistic("agreement of nodal counts", columns, metrics=metrics)


def moving_mean(values: Floats, window: int = WINDOW) -> Floats:
    """Mean over the `window` entries around each, fewer at the ends."""
    sums = np.concatenate([[0.0], np.cumsum(values)])
    here = np.arange(len(values))
    low, high = np.maximum(here - window // 2, 0), np.minimum(here + window // 2, len(values))
    return np.asarray((sums[high] - sums[low]) / (high - low))


def largest_change(reference: Signature, others: Mapping[str, Signature], part: str = "") -> Statistic:
    """Return how much signatures differ from a reference, relatively, for each of the others.

    Returns
    -------
    Statistic
        Rows are the others. Columns: largest and mean |x - y| / max(|x|, |y|). Metrics largest and mean over all.
    """
    known = reference.part(part)
    largest, mean = [], []
    for signature in others.values():
        values = signature.part(part)
        length = min(len(known), len(values))
        sizes = np.maximum(np.maximum(np.abs(known[:length]), np.abs(values[:length])), 1e-300)
        change = np.abs(values[:length] - known[:length]) / sizes
        largest.append(float(change.max()))
        mean.append(float(change.mean()))
    columns = {"largest": np.array(largest), "mean": np.array(mean)}
    metrics = {"largest": float(np.max(largest)), "mean": float(np.mean(mean))}
    return Statistic(f"change of {part or reference.name}", columns, tuple(others), metrics)
