"""Paired tests against values by hand: exact p of signed ranks, Holm's correction, the interval that t inverts."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from surfexp.statistics.paired_tests import paired_tests, power_by_subjects


def test_holm_corrects_each_kind_of_p_by_itself() -> None:
    """All n differences positive: signed ranks give 2^(1-n), whatever t gives, and Holm (3 p, 2 p, p) running upward."""
    rises = {"four": [1.0, 1.1, 1.2, 9.0], "five": [1.0, 2.0, 4.0, 8.0, 16.0], "six": [1.0, 1.5, 2.0, 2.5, 3.0, 3.5]}
    left = {name: np.array(values) for name, values in rises.items()}
    tests = paired_tests(left, {name: np.zeros(len(values)) for name, values in rises.items()})
    assert tests.p_wilcoxon == pytest.approx([0.125, 0.0625, 0.03125], abs=1e-15)
    assert tests.p_wilcoxon_holm == pytest.approx([0.125, 0.125, 0.09375], abs=1e-15)
    smallest, middle, largest = np.sort(tests.p_t)
    corrected = np.maximum.accumulate([3.0 * smallest, 2.0 * middle, largest])
    assert np.sort(tests.p_t_holm) == pytest.approx(np.minimum(corrected, 1.0), rel=1e-14)


@pytest.mark.parametrize("count", [3, 4, 7, 30])
def test_the_interval_of_the_effect_ends_at_zero_where_p_is_five_percent(count: int) -> None:
    """The 95 % interval holds 0 exactly where the t-test of the same differences does not reject at .05."""
    draws = np.random.default_rng(count).normal(size=count)
    standard = (draws - draws.mean()) / draws.std(ddof=1)
    edge = standard + stats.t.ppf(0.975, count - 1) / np.sqrt(count)
    tests = paired_tests({"x": 3.0 * edge}, {"x": np.zeros(count)})
    assert tests.p_t[0] == pytest.approx(0.05, rel=1e-10)
    assert tests.effect_low[0] == pytest.approx(0.0, abs=1e-12)
    assert tests.effect_high[0] == pytest.approx(2.0 * tests.effect[0], rel=1e-12)


def test_the_interval_is_that_of_the_mean_over_the_deviation() -> None:
    differences = np.random.default_rng(5).gamma(2.0, size=9) - 1.0
    tests = paired_tests({"x": differences + 4.0}, {"x": np.full(9, 4.0)})
    interval = stats.ttest_1samp(differences, 0.0).confidence_interval(0.95)
    ends = np.array([interval.low, interval.high]) / differences.std(ddof=1)
    assert [tests.effect_low[0], tests.effect_high[0]] == pytest.approx(list(ends), rel=1e-10)
    assert tests.effect[0] == pytest.approx(differences.mean() / differences.std(ddof=1), rel=1e-10)


def test_pairs_with_a_missing_value_leave_their_measurement_only() -> None:
    left = {"x": np.array([2.0, 3.0, np.nan, 5.0]), "y": np.array([1.0, 2.0, 4.0, 8.0])}
    right = {"x": np.array([1.0, 1.0, 1.0, 1.0]), "y": np.zeros(4)}
    tests = paired_tests(left, right)
    assert list(tests.subjects) == [3.0, 4.0]
    assert list(tests.left) == [10.0 / 3.0, 3.75] and list(tests.right) == [1.0, 0.0]
    assert tests.difference == pytest.approx([(2.0 / 3.0 + 1.0 + 8.0 / 6.0) / 3.0, 2.0])


def test_equal_differences_have_no_deviation_and_their_own_p() -> None:
    tests = paired_tests({"none": np.ones(4), "all": np.ones(4)}, {"none": np.ones(4), "all": np.zeros(4)})
    assert list(tests.p_wilcoxon) == [1.0, 2.0**-4] and tests.p_t[0] == 1.0 and tests.p_t[1] < 1e-299
    assert list(tests.effect) == [0.0, np.inf]


def test_power_is_the_level_where_nothing_differs_and_grows_with_the_difference() -> None:
    values = np.random.default_rng(0).standard_normal(500)
    values -= values.mean()
    nothing, some, much = (power_by_subjects(values + shift, [20], 1000)[0] for shift in (0.0, 0.5, 1.0))
    assert stats.binom.ppf(0.001, 1000, 0.05) <= 1000 * nothing <= stats.binom.ppf(0.999, 1000, 0.05)
    assert nothing < some < much and much > 0.95
