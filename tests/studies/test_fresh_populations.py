"""Counts of tests that find a difference, where it is known what there is to find."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.studies.sulci.fresh_populations import fresh_tests


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
