"""p-values of many tests: family-wise by the largest statistic, and false discovery rates."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats

# equal statistics of two rearrangements differ by rounding; they are ties
ROUNDING = 1e-9


def family_wise(observed: Floats, largest: Floats) -> Floats:
    """Return p-values corrected for all tests: the share of rearrangements whose largest statistic reaches the observed one.

    Parameters
    ----------
    observed : (...) float64
        0 or more.
    largest : (r,) float64
        Of each rearrangement, the unchanged one among them.

    Returns
    -------
    (...) float64
        At least 1 / r; 1 for an observed 0.
    """
    below = np.searchsorted(np.sort(largest), observed * (1.0 - ROUNDING), side="left")
    return np.asarray((len(largest) - below) / len(largest))


def false_discovery_rate(p: Floats) -> Floats:
    """Return p-values adjusted by Benjamini and Hochberg: rejecting up to q keeps the false discovery rate at q.

    Parameters
    ----------
    p : (n,) float64
        Independent, or positively dependent.

    Returns
    -------
    (n,) float64

    References
    ----------
    Benjamini and Hochberg: Controlling the false discovery rate (1995). Benjamini and Yekutieli (2001) for dependence.
    """
    order = np.argsort(p)
    steps = p[order] * len(p) / np.arange(1, len(p) + 1)
    adjusted = np.empty(len(p))
    adjusted[order] = np.minimum(np.minimum.accumulate(steps[::-1])[::-1], 1.0)
    return adjusted
