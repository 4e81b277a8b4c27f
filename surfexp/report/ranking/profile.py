"""Performance profiles: the share of problems that a method solves within a factor of the best.

Reference: E. D. Dolan, J. J. Moré (2002), "Benchmarking optimization software with performance profiles", Mathematical
Programming 91.
"""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.report.ranking.trials import Trials


def has_profile(trials: Trials) -> bool:
    """Whether ratios mean something: the metric is good when low, and positive wherever a method ended."""
    return trials.better == "lower" and bool((trials.values[~np.isnan(trials.values)] > 0.0).all())


def profiles(trials: Trials) -> tuple[Floats, Floats]:
    """Performance profiles of the methods.

    Parameters
    ----------
    trials : Trials
        Of a metric for which `has_profile` holds.

    Returns
    -------
    factors : (s,) float64
        The factors at which a share changes, from 1, ascending.
    shares : (s, m) float64
        Share of the problems that a method solved with at most so many times the best value. What failed is within no
        factor; a problem that nobody solved counts against all.

    Raises
    ------
    ValueError
        If values are not positive, or high is good.

    Examples
    --------
    >>> import numpy as np
    >>> trials = Trials("seconds", "lower", "s", ("a", "b"), np.array([[1.0, 2.0], [4.0, 1.0], [1.0, np.nan]]))
    >>> factors, shares = profiles(trials)
    >>> factors.tolist(), [[round(share, 2) for share in row] for row in shares.tolist()]
    ([1.0, 2.0, 4.0], [[0.67, 0.33], [0.67, 0.67], [1.0, 0.67]])
    """
    if not has_profile(trials):
        raise ValueError(f"{trials.metric!r} has no profile: it has to be positive, and good when it is low")
    values = np.where(np.isnan(trials.values), np.inf, trials.values)
    best = values.min(axis=1, keepdims=True)
    with np.errstate(invalid="ignore"):
        ratios = np.where(np.isfinite(values), values / best, np.inf)
    factors = np.unique(np.append(ratios[np.isfinite(ratios)], 1.0))
    return factors, (ratios[None, :, :] <= factors[:, None, None]).mean(axis=1)
