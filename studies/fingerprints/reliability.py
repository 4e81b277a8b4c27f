"""ICC(2,1) of the entries of a descriptor over people seen several times, with intervals and within donors."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.statistics.intraclass import intraclass_correlation
from surfexp.statistics.resampling import CENTRAL

BOOTSTRAPS = 400


def median_reliability(ratings: Floats, donors: Sequence[str], seed: int = 0) -> tuple[float, float, float]:
    """Return the median over entries of ICC(2,1), with the 95 % bootstrap interval.

    Donors are drawn where there are several, people where all are of one.

    Parameters
    ----------
    ratings : (p, k, e) float64
        People, times they were seen, entries. Entries in which nothing differs are left out.
    donors : sequence of p str
    seed : int

    Returns
    -------
    (float, float, float)
        NaN where no entry differs.
    """
    owners = np.unique(np.asarray(donors), return_inverse=True)[1]
    if owners.max() == 0:
        owners = np.arange(len(owners))
    groups = [np.flatnonzero(owners == owner) for owner in range(int(owners.max()) + 1)]
    rng, draws = np.random.default_rng(seed), []
    for _ in range(BOOTSTRAPS):
        chosen = np.concatenate([groups[k] for k in rng.integers(len(groups), size=len(groups))])
        draws.append(_median(intraclass_correlation(ratings[chosen])))
    low, high = np.nanpercentile(draws, CENTRAL) if np.isfinite(draws).any() else (np.nan, np.nan)
    return _median(intraclass_correlation(ratings)), float(low), float(high)


def reliability_within(ratings: Floats, donors: Sequence[str]) -> float:
    """Return the mean over donors of the median ICC(2,1) among the people of one donor: the donors' differences do not count.

    Parameters
    ----------
    ratings : (p, k, e) float64
    donors : sequence of p str
    """
    names = np.asarray(donors)
    return float(np.mean([_median(intraclass_correlation(ratings[names == donor])) for donor in dict.fromkeys(donors)]))


def constant_entries(ratings: Floats) -> int:
    """Return in how many entries nothing differs."""
    return int(np.isnan(intraclass_correlation(ratings)).sum())


def _median(values: Floats) -> float:
    known = values[np.isfinite(values)]
    return float(np.median(known)) if len(known) else np.nan
