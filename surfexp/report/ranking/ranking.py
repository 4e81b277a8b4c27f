"""How methods rank over the problems that they share, and which differences in rank are more than chance.

References
----------
J. Demšar (2006), "Statistical comparisons of classifiers over multiple data sets", Journal of Machine Learning Research 7;
A. Benavoli, G. Corani, F. Mangili (2016), "Should we really use post-hoc tests based on mean-ranks?", the same 17: whether
two methods differ must not depend on which others are there. So pairs are compared by the signed ranks of their
differences, corrected by Holm for the number of pairs, and not by mean ranks.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy import stats

from surfexp.contract.arrays import Floats, Integers
from surfexp.report.ranking.trials import Trials

LEVEL = 0.05


@dataclass(frozen=True, eq=False)
class Ranking:
    """Methods from the best mean rank to the worst.

    Parameters
    ----------
    trials : Trials
    order : (m,) int64
        Places of the methods in `trials`, best first; all that follows is in this order.
    ranks : (m,) float64
        Mean ranks, 1 is best; equal values share theirs, and what failed ranks last.
    mean, deviation : (m,) float64
        Of the metric over the solved problems.
    difference, low, high : (m,) float64
        Mean of method less best, and its 95 % interval by Student's t, over the data with a problem that both solved;
        NaN for the best itself and for under two such data.
    p : (m, m) float64
        Of the signed-rank tests, corrected by Holm. A problem that one of two methods did not solve has the largest of
        their differences; 1 where all are zero.
    p_friedman : float
        That all methods rank alike; NaN for two methods.
    groups : tuple of (int, int)
        First and last place of each longest run of methods no two of which differ at 5 %.

    Notes
    -----
    Tests and intervals take the mean over the problems of the same data as one sample.
    """

    trials: Trials
    order: Integers
    ranks: Floats
    mean: Floats
    deviation: Floats
    difference: Floats
    low: Floats
    high: Floats
    p: Floats
    p_friedman: float
    groups: tuple[tuple[int, int], ...]

    @property
    def methods(self) -> tuple[str, ...]:
        """Names, best first."""
        return tuple(self.trials.methods[place] for place in self.order)

    @property
    def failed(self) -> tuple[int, ...]:
        """How many problems each method did not solve, best first."""
        return tuple(self.trials.failed[place] for place in self.order)


def rank(trials: Trials) -> Ranking:
    """Rank the methods of some trials.

    Parameters
    ----------
    trials : Trials

    Examples
    --------
    >>> import numpy as np
    >>> values = np.array([[1.0, 2.0, 3.0]] * 7) + np.arange(7)[:, None]
    >>> found = rank(Trials("error", "lower", "mm", ("a", "b", "c"), values))
    >>> found.methods, found.ranks.tolist(), found.groups
    (('a', 'b', 'c'), [1.0, 2.0, 3.0], ())
    >>> found.difference.tolist()
    [nan, 1.0, 2.0]
    """
    signed = trials.values if trials.better == "lower" else -trials.values
    worst = np.where(np.isnan(signed), np.inf, signed)
    each = stats.rankdata(worst, axis=1)
    order = np.argsort(each.mean(axis=0), kind="stable")
    each, values = each[:, order], trials.values[:, order]
    samples = trials.samples
    p = _pairwise(worst[:, order], samples)
    p_friedman = _friedman(_of_samples(each, samples)) if len(order) > 2 else float("nan")
    solved = [column[~np.isnan(column)] for column in values.T]
    mean = np.array([column.mean() if len(column) else np.nan for column in solved])
    deviation = np.array([column.std(ddof=1) if len(column) > 1 else np.nan for column in solved])
    apart = _of_samples(values - values[:, :1], samples)
    difference, low, high = np.array([_interval(column) for column in apart.T]).T
    difference[0] = low[0] = high[0] = np.nan
    groups = tuple(_alike(p > LEVEL))
    return Ranking(trials, order, each.mean(axis=0), mean, deviation, difference, low, high, p, p_friedman, groups)


def _of_samples(values: Floats, samples: Integers) -> Floats:
    """Means over the problems of each sample, without those that have no number: (s, m) of (n, m)."""
    count, total = np.zeros((2, samples.max() + 1, values.shape[1]))
    np.add.at(count, samples, ~np.isnan(values))
    np.add.at(total, samples, np.nan_to_num(values, nan=0.0, posinf=np.inf, neginf=-np.inf))
    return np.divide(total, count, out=np.full(total.shape, np.nan), where=count > 0)


def _friedman(ranks: Floats) -> float:
    """The p-value of Friedman's test of ranks, ties corrected; 1 where every method ties on every problem."""
    return 1.0 if not np.ptp(ranks, axis=1).any() else float(stats.friedmanchisquare(*ranks.T).pvalue)


def _pairwise(worst: Floats, samples: Integers) -> Floats:
    from statsmodels.stats.multitest import multipletests

    pairs = list(combinations(range(worst.shape[1]), 2))
    corrected = multipletests([_signed_ranks(worst[:, i], worst[:, j], samples) for i, j in pairs], method="holm")[1]
    p = np.ones((worst.shape[1],) * 2)
    for (i, j), value in zip(pairs, corrected, strict=True):
        p[i, j] = p[j, i] = value
    return p


def _signed_ranks(one: Floats, other: Floats, samples: Integers) -> float:
    with np.errstate(invalid="ignore"):
        differences = np.where(one == other, 0.0, one - other)
        found = _of_samples(differences[:, None], samples)[:, 0]
    found = found[~np.isnan(found) & (found != 0.0)]  # each solved what the other did not: neither is better
    return float(stats.wilcoxon(found).pvalue) if len(found) else 1.0


def _interval(differences: Floats) -> tuple[float, float, float]:
    found = differences[~np.isnan(differences)]
    if len(found) < 2:
        return (float("nan"),) * 3
    reach = float(stats.t.ppf(0.975, len(found) - 1) * found.std(ddof=1) / np.sqrt(len(found)))
    return float(found.mean()), float(found.mean() - reach), float(found.mean() + reach)


def _alike(same: np.ndarray) -> Iterator[tuple[int, int]]:
    """The longest runs of places within which every pair is the same."""
    last = -1
    for first in range(len(same)):
        end = first
        while end + 1 < len(same) and same[first : end + 2, first : end + 2].all():
            end += 1
        if end > max(first, last):
            yield first, end
            last = end
