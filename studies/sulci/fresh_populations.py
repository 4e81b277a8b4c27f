"""False positives in populations that share no subject: how often a test finds a difference that nobody planted."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy import stats

from surfexp.contract.arrays import Floats
from surfexp.statistics.paired_tests import paired_tests

from .asymmetry import FEWEST_PAIRS, measured
from .population_study import Table


def fresh_tests(differences: Floats, size: int, level: float = 0.05) -> tuple[int, int]:
    """Return in how many populations a t-test finds a difference, and the number of tests.

    Sides stay as they are, so that whatever sets them apart by mistake is found too.

    Parameters
    ----------
    differences : (subjects, sulci) float64
        Left less right; NaN where a length is missing.
    size : int
        Subjects of each population: the first so many, the next so many, and so on; those left over are not used.
    level : float

    Raises
    ------
    ValueError
        If the size is below 3, or there are too few subjects for one population.
    """
    count = len(differences)
    if not FEWEST_PAIRS <= size <= count:
        raise ValueError(f"populations of {size} subjects, take {FEWEST_PAIRS} to {count}, the number of subjects")
    found = tests = 0
    for start in range(0, count - size + 1, size):
        for values in differences[start : start + size].T:
            values = values[np.isfinite(values)]
            if len(values) >= FEWEST_PAIRS:
                tests += 1
                found += int(np.ptp(values) > 0.0 and stats.ttest_1samp(values, 0.0).pvalue < level)
    return found, tests


def fresh_study(table: Table, sizes: Sequence[int], level: float = 0.05) -> tuple[dict[str, Floats], dict[str, float]]:
    """Return columns by size (subjects, tests, shares by estimator, the 95 % interval of the level) and metrics.

    A share of no test at all is NaN and no metric. Estimators with too few pairs are left out, see `measured`.

    Parameters
    ----------
    table : mapping
        By estimator and side (subjects, sulci) lengths, with nothing planted.
    sizes : sequence of int

    Raises
    ------
    ValueError
        If a size is out of bounds, or no estimator has three pairs of lengths in every sulcus.
    """
    table = measured(table)[0]
    columns: dict[str, list[float]] = {"subjects": [float(size) for size in sizes]}
    metrics: dict[str, float] = {}
    for estimator, lengths in table.items():
        differences = lengths["left"] - lengths["right"]
        for size in sizes:
            found, tests = fresh_tests(differences, size, level)
            columns.setdefault(estimator, []).append(found / tests if tests else np.nan)
            columns.setdefault(f"tests, {estimator}", []).append(float(tests))
            metrics[f"tests, {estimator}, {size}"] = float(tests)
            if tests:
                metrics[f"false positives, {estimator}, {size}"] = found / tests
        names = [f"sulcus {k + 1}, {estimator}" for k in range(differences.shape[1])]
        sides = [dict(zip(names, lengths[side].T, strict=True)) for side in lengths]
        whole = paired_tests(sides[0], sides[1])
        metrics |= {
            f"least p of all, {estimator}": float(whole.p_t_holm.min()),
            f"largest difference, {estimator}": float(np.abs(whole.difference).max()),
            f"all subjects, {estimator}": float(whole.subjects.min()),
        }
    of_first = np.array(columns[f"tests, {next(iter(table))}"])
    counted = np.where(of_first > 0, of_first, np.nan)
    low, high = (stats.binom.ppf(q, counted, level) / counted for q in (0.025, 0.975))
    arrays = {name: np.array(values) for name, values in columns.items()}
    return {**arrays, "low": np.asarray(low), "high": np.asarray(high)}, metrics
