"""Correlations against numpy's, p-values by hand, and intervals that know which pairs share a map."""

import numpy as np
import pytest
from scipy.stats import pearsonr

from surfexp.nulls.rejection import correlations, crossed_interval, effective_interval, p_values, parametric_p_values

RANDOM = np.random.default_rng(0)
MAPS, PARTNERS = RANDOM.standard_normal((60, 4)) + 3.0, RANDOM.standard_normal((60, 5)) - 2.0


def test_correlations_are_numpys() -> None:
    wanted = np.corrcoef(MAPS.T, PARTNERS.T)[:4, 4:]
    np.testing.assert_allclose(correlations(MAPS, PARTNERS), wanted, atol=1e-14)


def test_unknown_vertices_and_vertices_of_weight_0_do_not_count() -> None:
    holes = MAPS.copy()
    holes[:10, 0], holes[30:50, 2] = np.nan, np.nan
    found = correlations(holes, PARTNERS)
    for column in range(4):
        known = np.isfinite(holes[:, column])
        wanted = np.corrcoef(holes[known, column], PARTNERS[known].T)[0, 1:]
        np.testing.assert_allclose(found[column], wanted, atol=1e-14)
    weights = np.ones(60)
    weights[:10] = 0.0
    np.testing.assert_allclose(
        correlations(MAPS, PARTNERS, weights), correlations(MAPS[10:], PARTNERS[10:]), atol=1e-14
    )
    np.testing.assert_allclose(correlations(holes, PARTNERS, weights)[0], correlations(MAPS[10:], PARTNERS[10:])[0])


def test_a_weight_of_two_is_the_vertex_twice() -> None:
    weights = RANDOM.integers(1, 4, 60)
    repeated = [np.repeat(maps, weights, axis=0) for maps in (MAPS, PARTNERS)]
    np.testing.assert_allclose(correlations(MAPS, PARTNERS, weights.astype(float)), correlations(*repeated), atol=1e-14)


def test_p_values_by_hand() -> None:
    null = np.array([[0.1, 0.9], [-0.5, -0.2], [0.3, 0.1], [np.nan, 0.0]])
    np.testing.assert_allclose(p_values(np.array([0.4, -0.2]), null), [3 / 5, 3 / 5])
    np.testing.assert_allclose(p_values(np.array([0.5, 1.0]), null), [3 / 5, 1 / 5])


def test_the_parametric_test_is_pearsons() -> None:
    found = parametric_p_values(correlations(MAPS, PARTNERS)[1], 60)
    np.testing.assert_allclose(found, [pearsonr(MAPS[:, 1], column).pvalue for column in PARTNERS.T])
    assert parametric_p_values(np.array([1.0]), 60)[0] < 1e-100


def test_the_interval_of_independent_pairs_is_fishers() -> None:
    wanted = pearsonr(MAPS[:, 1], PARTNERS[:, 2]).confidence_interval()
    observed = float(correlations(MAPS[:, [1]], PARTNERS[:, [2]])[0, 0])
    # of 60 independent pairs null correlations have the variance 1 / 59
    null = np.array([1.0, -1.0, 1.0, np.nan]) / np.sqrt(59)
    low, high, count = effective_interval(observed, null)
    assert (low, high) == pytest.approx((wanted.low, wanted.high)) and count == pytest.approx(60.0)
    assert effective_interval(0.9, np.array([0.9, -0.9]))[:2] == (-1.0, 1.0)
    assert effective_interval(1.0, null)[:2] == (1.0, 1.0)


def test_the_interval_of_pairs_that_share_maps() -> None:
    """Where a row decides all of its pairs, the interval is that of the number of rows."""
    share, low, high = crossed_interval(np.repeat(np.arange(40) < 10, 50).reshape(40, 50))
    assert (
        share == 0.25 and low == pytest.approx(0.25 - 0.134, abs=0.02) and high == pytest.approx(0.25 + 0.134, abs=0.02)
    )
    by_column = crossed_interval(np.tile(np.arange(50) < 10, (40, 1)))
    assert by_column[0] == 0.2 and by_column[2] - by_column[1] == pytest.approx(4 * np.sqrt(0.16 / 50), abs=0.03)
    independent = crossed_interval(np.random.default_rng(1).random((100, 100)) < 0.05)
    assert 0.0085 < independent[2] - independent[1] < 0.025
    assert crossed_interval(np.zeros((3, 3), dtype=bool)) == (0.0, 0.0, 0.0)


def test_bad_input_is_refused() -> None:
    with pytest.raises(ValueError, match="maps are of 60 vertices, partners of 59"):
        correlations(MAPS, PARTNERS[1:])
    with pytest.raises(ValueError, match="one finite value"):
        correlations(MAPS, np.where(PARTNERS > 0, np.nan, PARTNERS))
    with pytest.raises(ValueError, match="weight of 0 or more"):
        correlations(MAPS, PARTNERS, -np.ones(60))
    with pytest.raises(ValueError, match=r"\(5,\) correlations are given with nulls \(0, 5\)"):
        p_values(np.zeros(5), np.zeros((0, 5)))
    with pytest.raises(ValueError, match="1 maps were paired with 5"):
        crossed_interval(np.zeros((1, 5), dtype=bool))
