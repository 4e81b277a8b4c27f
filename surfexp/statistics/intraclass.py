"""The intraclass correlation ICC(2,1): how much of what differs between measurements differs between people."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats


def intraclass_correlation(ratings: Floats) -> Floats:
    """Return ICC(2,1), two-way random effects, absolute agreement, of a single measurement (Shrout and Fleiss 1979).

    It is (B - E) / (B + (k - 1) E + k (J - E) / n) with the mean squares between n people, between k measurements, and
    of the rest. A shift that all people share counts against it.

    Parameters
    ----------
    ratings : (n, k) or (n, k, e) float64
        People by measurements, of one entry or of e entries at once.

    Returns
    -------
    () or (e,) float64
        At most 1; NaN for an entry in which nothing differs.

    Raises
    ------
    ValueError
        If there are fewer than two people or measurements, or a rating is not finite.

    Examples
    --------
    >>> table = np.array([[9.0, 2, 5, 8], [6, 1, 3, 2], [8, 4, 6, 8], [7, 1, 2, 6], [10, 5, 6, 9], [6, 2, 4, 7]])
    >>> round(float(intraclass_correlation(table)), 2)
    0.29
    """
    table = np.asarray(ratings, dtype=np.float64)
    if table.ndim not in (2, 3) or min(table.shape[:2]) < 2:
        raise ValueError(f"ratings have shape {table.shape}, at least 2 subjects times 2 measurements are needed")
    if not np.isfinite(table).all():
        raise ValueError(f"{int((~np.isfinite(table)).sum())} ratings are not finite, all must be")
    people, measurements = table.shape[:2]
    mean = table.mean(axis=(0, 1))
    of_people, of_measurements = table.mean(axis=1), table.mean(axis=0)
    between = measurements * ((of_people - mean) ** 2).sum(axis=0) / (people - 1)
    shifts = people * ((of_measurements - mean) ** 2).sum(axis=0) / (measurements - 1)
    rest = ((table - of_people[:, None] - of_measurements[None] + mean) ** 2).sum(axis=(0, 1))
    rest = rest / ((people - 1) * (measurements - 1))
    whole = between + (measurements - 1) * rest + measurements * (shifts - rest) / people
    # what rounding leaves of equal ratings is no difference
    differs = np.ptp(table, axis=(0, 1)) > 1e-12 * np.abs(table).max(axis=(0, 1))
    return np.divide(between - rest, whole, out=np.full(np.shape(whole), np.nan), where=differs)
