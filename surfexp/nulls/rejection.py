"""The test of a correlation against null maps, and how often it rejects."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.stats import norm as normal
from scipy.stats import t as student

from surfexp.contract.arrays import Floats

ROUNDING = 1e-12
DRAWS = 2000
CENTRAL = (2.5, 97.5)


def correlations(maps: Floats, partners: Floats, weights: Floats | None = None) -> Floats:
    """Return the correlation of each map with each partner, over the vertices at which the map is known.

    Parameters
    ----------
    maps : (n, r) float64
        NaN where unknown, as spins leave it.
    partners : (n, c) float64
        Finite.
    weights : (n,) float64, optional
        Areas of the vertices; default: all vertices count the same.

    Returns
    -------
    (r, c) float64
        NaN for a map or a partner that is constant there.

    Raises
    ------
    ValueError
        If partners are not finite, numbers of vertices differ, or a weight is negative.
    """
    n = len(maps)
    weight = np.ones(n) if weights is None else np.asarray(weights, dtype=np.float64)
    if len(partners) != n or weight.shape != (n,) or not np.isfinite(partners).all() or not (weight >= 0.0).all():
        raise ValueError(
            f"maps are of {n} vertices, partners of {len(partners)}, weights of {weight.shape}: one finite value and one "
            "weight of 0 or more for each vertex are needed"
        )
    known = np.isfinite(maps)
    other = partners - np.average(partners, axis=0, weights=weight)
    held = weight[:, None] * known
    totals = held.sum(axis=0)
    with np.errstate(invalid="ignore", divide="ignore"):
        means = (held * np.where(known, maps, 0.0)).sum(axis=0) / totals
        centred = np.where(known, maps - means, 0.0)
        spread = np.sqrt((weight @ centred**2)[:, None])
        if known.all():
            shift = np.zeros((maps.shape[1], 1))
            squares = np.broadcast_to(weight @ other**2, (maps.shape[1], partners.shape[1]))
        else:
            shift = (held.T @ other) / totals[:, None]
            squares = held.T @ other**2 - totals[:, None] * shift**2
        return np.asarray((weight[:, None] * centred).T @ other / (spread * np.sqrt(squares)))


def p_values(observed: Floats, null: Floats) -> Floats:
    """Return two-sided p-values (1 + exceedances) / (1 + r) of correlations by their modulus.

    Parameters
    ----------
    observed : (c,) float64
    null : (r, c) float64
        NaN counts as exceeding.

    Returns
    -------
    (c,) float64
        At least 1 / (1 + r), and exact where the observed one and the nulls can be exchanged.

    Raises
    ------
    ValueError
        If there is no null, or the lengths differ.
    """
    if null.ndim != 2 or not len(null) or null.shape[1:] != observed.shape:
        raise ValueError(f"{observed.shape} correlations are given with nulls {null.shape}: (c,) and (r, c) with r > 0")
    below = np.abs(null) < np.abs(observed) * (1.0 - ROUNDING)
    return np.asarray((1.0 + (~below).sum(axis=0)) / (1.0 + len(null)))


def parametric_p_values(observed: Floats, count: int) -> Floats:
    """Return two-sided p-values of correlations of `count` independent normal pairs, by Student's distribution.

    Parameters
    ----------
    observed : (c,) float64
    count : int
        At least 3.

    Returns
    -------
    (c,) float64
    """
    with np.errstate(divide="ignore"):
        ratio = np.abs(observed) * np.sqrt((count - 2) / (1.0 - observed**2))
    return np.asarray(2.0 * student.sf(ratio, count - 2))


def effective_interval(observed: float, null: Floats) -> tuple[float, float, float]:
    """Return the ends of a 95 % confidence interval of a correlation, and of how many independent observations it is.

    Correlations of m independent pairs without a relation have the variance 1 / (m - 1). The variance of null correlations
    about 0 gives m; the interval is Fisher's, tanh(artanh r +- 1.96 / sqrt(m - 3)).

    Parameters
    ----------
    observed : float
    null : (r,) float64
        Correlations of null maps; NaN does not count.

    Returns
    -------
    float
    float
    float
        m. The interval is -1 to 1 where m is 3 or less.

    References
    ----------
    Clifford, Richardson, Hemon: Assessing the significance of the correlation between two spatial processes (1989).
    """
    with np.errstate(divide="ignore"):
        count = float(1.0 + 1.0 / np.nanmean(null**2))
        centre = np.arctanh(np.clip(observed, -1.0, 1.0))
    if not count > 3.0:
        return -1.0, 1.0, count
    reach = normal.isf(0.025) / np.sqrt(count - 3.0)
    return float(np.tanh(centre - reach)), float(np.tanh(centre + reach)), count


def crossed_interval(rejected: NDArray[np.bool_], seed: int = 0) -> tuple[float, float, float]:
    """Return a share over all pairs of two samples, and the ends of its 95 % interval.

    Pairs that share a map are not independent, so maps are drawn again and not pairs: 2,000 bootstraps of the rows and, apart
    from them, of the columns. Counting what belongs to neither rows nor columns twice, it errs to the wide side.

    Parameters
    ----------
    rejected : (a, b) bool
        A row for each map of the one sample, a column for each of the other.
    seed : int

    Returns
    -------
    float
    float
    float

    Raises
    ------
    ValueError
        If a sample has fewer than 2 maps.
    """
    rows, columns = rejected.shape
    if min(rows, columns) < 2:
        raise ValueError(f"{rows} maps were paired with {columns}, at least 2 of each are needed for an interval")
    random = np.random.default_rng(seed)
    drawn_rows = random.multinomial(rows, np.full(rows, 1.0 / rows), DRAWS)
    drawn_columns = random.multinomial(columns, np.full(columns, 1.0 / columns), DRAWS)
    shares = ((drawn_rows @ rejected.astype(float)) * drawn_columns).sum(axis=1) / (rows * columns)
    low, high = np.percentile(shares, CENTRAL)
    return float(rejected.mean()), float(low), float(high)
