"""Counts of tests that find a difference, where it is known what there is to find."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from surfexp_studies.sulci.fresh_populations import fresh_study, fresh_tests


def test_a_shift_is_found_in_every_population_and_nothing_in_none() -> None:
    draws = np.random.default_rng(0).normal(size=(40, 5))
    assert fresh_tests(draws + 50.0, 8) == (25, 25)
    assert fresh_tests(np.vstack([draws, -draws])[np.argsort(np.tile(np.arange(40), 2), kind="stable")], 8) == (0, 50)
    assert fresh_tests(np.full((40, 5), 3.0), 8) == (0, 25)  # the same number everywhere has no spread to test by


def test_missing_lengths_leave_fewer_tests_and_those_left_over_are_not_used() -> None:
    draws = np.random.default_rng(1).normal(size=(43, 2)) + 50.0
    draws[:8, 0] = np.nan
    assert fresh_tests(draws, 8) == (9, 9)
    with pytest.raises(ValueError, match="populations of 44 subjects"):
        fresh_tests(draws, 44)


@pytest.mark.slow
def test_populations_without_a_common_subject() -> None:
    rng = np.random.default_rng(4)
    differences = rng.normal(0.0, 1.0, (1003, 4))
    found, tests = fresh_tests(differences, 5)
    assert tests == 800 and 0.03 < found / tests < 0.07
    apart = sum(stats.ttest_1samp(differences[5 * k : 5 * k + 5], 0.0).pvalue < 0.05 for k in range(200))
    assert found == apart.sum()
    # a fault that makes the left side longer is found, where exchanges of sides would hide it
    assert fresh_tests(differences + 0.5, 40)[0] / fresh_tests(differences, 40)[1] > 0.7
    differences[:3, 0] = np.nan
    assert fresh_tests(differences, 5)[1] == 799
    left = rng.normal(100.0, 5.0, (1003, 4))
    table = {"true": {"left": left + differences, "right": left}}
    columns, metrics = fresh_study(table, [5, 40])
    assert columns["tests, true"].tolist() == [799, 100]
    assert columns["low"][0] < 0.05 < columns["high"][0] and columns["high"][0] < columns["high"][1]
    assert metrics["least p of all, true"] > 0.01 and metrics["all subjects, true"] == 1000
    with pytest.raises(ValueError, match="take 3 to 1003"):
        fresh_tests(differences, 2)


def test_one_test_alone_has_an_interval() -> None:
    rng = np.random.default_rng(0)
    single = {side: rng.normal(100.0, 5.0, (4, 1)) for side in ("left", "right")}
    columns, metrics = fresh_study({"single": single}, [4])
    assert metrics["tests, single, 4"] == 1
    assert (columns["low"][0], columns["high"][0]) == (0.0, 1.0)


@pytest.mark.slow
def test_fresh_populations_leave_out_an_estimator_that_measures_too_few_pairs() -> None:
    rng = np.random.default_rng(0)
    whole = {side: rng.normal(100.0, 5.0, (9, 2)) for side in ("left", "right")}
    # one complete pair; three, but never three in a population of three
    single, scattered = (
        {"left": np.where(np.isin(np.arange(9), kept)[:, None], whole["left"], np.nan), "right": whole["right"]}
        for kept in ([4], [0, 3, 6])
    )
    alone = fresh_study({"whole": whole}, [3])
    columns, metrics = fresh_study({"whole": whole, "single": single, "scattered": scattered}, [3])
    assert not any("single" in name for name in (*columns, *metrics))
    assert metrics["tests, scattered, 3"] == 0 and "false positives, scattered, 3" not in metrics
    assert np.isnan(columns["scattered"]).all() and metrics["all subjects, scattered"] == 3
    assert alone[1].items() <= metrics.items() and metrics["tests, whole, 3"] == 6
    with pytest.raises(ValueError, match=r"no estimator \(single\) has 3 pairs of lengths in every sulcus"):
        fresh_study({"single": single}, [3])
