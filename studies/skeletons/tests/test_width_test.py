"""Welch's t by hand and against scipy, for groups of unequal size and spread; Westfall and Young's order of p."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from surfexp_studies.skeletons.positionwise_comparison import pointwise_test


def test_welch_by_hand() -> None:
    """Means 2 and 0, variances 4 of three members and 2/3 of four: t = 2 / sqrt(4/3 + 1/6)."""
    first, second = np.array([[0.0], [2.0], [4.0]]), np.array([[-1.0], [0.0], [0.0], [1.0]])
    assert pointwise_test(first, second, permutations=1).statistic == pytest.approx([2.0 / np.sqrt(1.5)], rel=1e-14)


@pytest.mark.parametrize(("size", "other"), [(3, 12), (9, 4), (6, 6)])
def test_welch_agrees_with_scipy(size: int, other: int) -> None:
    rng = np.random.default_rng(size)
    first, second = rng.normal(0.5, 3.0, (size, 7)), rng.normal(0.0, 1.0, (other, 7))
    expected = stats.ttest_ind(first, second, equal_var=False).statistic
    assert pointwise_test(first, second, permutations=1).statistic == pytest.approx(expected, rel=1e-12)


def test_p_counts_the_observed_grouping_and_every_one_as_large() -> None:
    """Two groups far apart: of the 20 groupings of six members only two give |t| as large, so p is near 1/10."""
    first, second = np.array([[0.0], [1.0], [2.0]]), np.array([[10.0], [11.0], [12.0]])
    test = pointwise_test(first, second, permutations=4000, seed=1)
    assert test.statistic[0] < 0.0
    assert test.uncorrected[0] == pytest.approx(0.1, abs=0.02)
    assert test.corrected[0] == test.uncorrected[0]
    alike = pointwise_test(first, first, permutations=50)
    assert alike.statistic[0] == 0.0 and alike.uncorrected[0] == 1.0


def test_correction_for_many_positions_never_lowers_p() -> None:
    rng = np.random.default_rng(3)
    test = pointwise_test(rng.normal(size=(8, 20)), rng.normal(size=(5, 20)), permutations=200)
    assert (test.corrected >= test.uncorrected).all() and test.corrected.min() > test.uncorrected.min()
    assert test.uncorrected.min() >= 1.0 / 201.0
