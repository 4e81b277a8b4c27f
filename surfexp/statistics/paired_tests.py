"""Left against right in a population: paired tests, corrected for their number, with effect sizes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy import stats

from surfexp.contract.arrays import Floats
from surfexp.extras import require_installed

SMALLEST = 1e-300


@dataclass(frozen=True, eq=False)
class PairedTests:
    """Tests of several measurements; arrays have one entry for each.

    Parameters
    ----------
    names : tuple of str
    left, right : (m,) float64
        Means.
    p_t, p_t_holm : (m,) float64
        Paired t-test, and corrected by Holm for m tests.
    p_wilcoxon, p_wilcoxon_holm : (m,) float64
        Signed ranks, the same.
    effect : (m,) float64
        Cohen's d of the differences: mean over standard deviation.
    effect_low, effect_high : (m,) float64
        95 % confidence interval of the mean difference over the standard deviation.
    difference : (m,) float64
        Mean of 2 (left - right) / (left + right).
    subjects : (m,) float64
        Pairs without a missing value.
    """

    names: tuple[str, ...]
    left: Floats
    right: Floats
    p_t: Floats
    p_t_holm: Floats
    p_wilcoxon: Floats
    p_wilcoxon_holm: Floats
    effect: Floats
    effect_low: Floats
    effect_high: Floats
    difference: Floats
    subjects: Floats


def paired_tests(left: Mapping[str, Floats], right: Mapping[str, Floats]) -> PairedTests:
    """Test whether left and right differ, for each measurement; pairs with a NaN are left out of theirs.

    Raises
    ------
    ValueError
        If names or lengths differ, or fewer than three pairs are complete.
    """
    require_installed("Holm's correction", "statsmodels")
    from statsmodels.stats.multitest import multipletests

    if list(left) != list(right):
        raise ValueError(f"measurements are {list(left)} left and {list(right)} right, they must be the same")
    rows = []
    for name in left:
        first, second = np.asarray(left[name], float), np.asarray(right[name], float)
        if first.shape != second.shape:
            raise ValueError(f"{name!r} has {len(first)} values left and {len(second)} right, pairs are needed")
        whole = np.isfinite(first) & np.isfinite(second)
        if whole.sum() < 3:
            raise ValueError(f"{name!r} has {int(whole.sum())} complete pairs, at least 3 are needed")
        first, second = first[whole], second[whole]
        rows.append((first.mean(), second.mean(), *_tests(first - second), *_relative(first, second), len(first)))
    table = np.array(rows, dtype=np.float64).T
    p_t, p_w = np.maximum(table[2], SMALLEST), np.maximum(table[3], SMALLEST)
    holm = [np.asarray(multipletests(p, method="holm")[1]) for p in (p_t, p_w)]
    return PairedTests(tuple(left), table[0], table[1], p_t, holm[0], p_w, holm[1], *table[4:])


def _tests(differences: Floats) -> tuple[float, float, float, float, float]:
    """p of t and of signed ranks, Cohen's d and its interval."""
    count, deviation = len(differences), float(differences.std(ddof=1))
    if deviation == 0.0:
        same = bool(differences.mean() == 0.0)
        return (1.0, 1.0, 0.0, 0.0, 0.0) if same else (0.0, 2.0**-count, np.inf, np.inf, np.inf)
    effect = float(differences.mean()) / deviation
    reach = float(stats.t.ppf(0.975, count - 1)) / np.sqrt(count)
    p_t = float(stats.ttest_1samp(differences, 0.0).pvalue)
    return p_t, float(stats.wilcoxon(differences).pvalue), effect, effect - reach, effect + reach


def _relative(first: Floats, second: Floats) -> tuple[float]:
    total = first + second
    shares = np.divide(2.0 * (first - second), total, out=np.zeros(len(total)), where=total != 0.0)
    return (float(shares.mean()),)


def rate_in_halves(differences: Floats, draws: int = 200, level: float = 0.05, seed: int = 0) -> float:
    """Return how often a t-test finds a difference in a random half of the pairs, sides as they are.

    A bias between the sides stays in every half, so that it shows. Halves of one sample vary half as much as samples drawn
    afresh: where there is no bias the rate lies under the level.

    Parameters
    ----------
    differences : (n,) float64
        Left less right; NaN is left out. Of fewer than six pairs three are drawn.
    """
    values = differences[np.isfinite(differences)]
    size = max(len(values) // 2, min(len(values), 3))
    order = np.random.default_rng(seed).permuted(np.tile(np.arange(len(values)), (draws, 1)), axis=1)
    return float((stats.ttest_1samp(values[order[:, :size]], 0.0, axis=1).pvalue < level).mean())


def power_by_subjects(
    differences: Floats, sizes: list[int], draws: int = 200, level: float = 0.05, seed: int = 0
) -> Floats:
    """Return for each size the share of samples of so many pairs, with repetition, in which a t-test finds a difference."""
    values = differences[np.isfinite(differences)]
    rng = np.random.default_rng(seed)
    return np.array(
        [
            float((stats.ttest_1samp(rng.choice(values, (draws, size)), 0.0, axis=1).pvalue < level).mean())
            for size in sizes
        ]
    )
