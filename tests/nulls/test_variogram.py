"""Variograms against sums over all pairs; nulls that have the variogram of their map."""

import numpy as np
import pytest

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.nulls.fields import gaussian_fields
from surfexp.nulls.kept import values_error, variogram_error
from surfexp.nulls.neighbourhoods import nearest_along_surface
from surfexp.nulls.variogram import VariogramPairs, variogram_pairs
from surfexp.nulls.variogram_matching import VariogramMatching, nonnegative_line
from surfexp.operators.fem import fem
from surfexp.smoothing.geodesic_gaussian import near_distances

BALL = icosphere(3)
COUNT = len(BALL.mesh.vertices)
NEAREST = nearest_along_surface(BALL.mesh, 200)
PAIRS = variogram_pairs(BALL.mesh, reach=1.2, lags=12)
MATCHING = VariogramMatching(*NEAREST, PAIRS, (0.05, 0.1, 0.3, 0.6, 1.0))
SMOOTH = gaussian_fields(fem(BALL.mesh), 0.7, 3, 1)
WHITE = np.random.default_rng(5).standard_normal(COUNT)


def test_the_nearest_vertices_are_those_of_the_distances() -> None:
    neighbours, lengths = NEAREST
    distances = near_distances(BALL.mesh, 10.0).toarray()
    np.testing.assert_array_equal(neighbours[:, 0], np.arange(COUNT))
    np.testing.assert_allclose(lengths, np.sort(distances, axis=1)[:, :200])
    np.testing.assert_allclose(np.take_along_axis(distances, neighbours, axis=1), lengths)
    whole = nearest_along_surface(icosphere(1).mesh, 42)
    assert (np.sort(whole[0], axis=1) == np.arange(42)).all()
    with pytest.raises(ValueError, match=r"43 nearest vertices are asked for, the smallest component has 42: 1\.\.42"):
        nearest_along_surface(icosphere(1).mesh, 43)
    with pytest.raises(ValueError, match="0 nearest vertices"):
        nearest_along_surface(icosphere(1).mesh, 0)


def test_the_variogram_is_the_weighted_mean_over_all_pairs() -> None:
    """Where no interval has more than 800 pairs none is left out."""
    small = icosphere(1)
    pairs = variogram_pairs(small.mesh, reach=1.5, lags=5)
    distances = near_distances(small.mesh, 1.5).toarray()
    first, second = np.nonzero(np.triu(distances, 1))
    values = np.random.default_rng(0).standard_normal(42)
    for lag, found in zip((0.3, 0.6, 0.9, 1.2, 1.5), pairs.of(values), strict=True):
        weights = np.exp(-0.5 * (2.68 * (distances[first, second] - lag) / 0.9) ** 2)
        wanted = weights @ (values[first] - values[second]) ** 2 / (2.0 * weights.sum())
        assert found == pytest.approx(wanted, rel=1e-12)
    np.testing.assert_allclose(pairs.lags, [0.3, 0.6, 0.9, 1.2, 1.5])
    np.testing.assert_allclose(pairs.of(np.ones(42)), 0.0, atol=1e-15)


def test_pairs_are_drawn_from_a_sample_and_evenly_over_the_lags() -> None:
    pairs = variogram_pairs(BALL.mesh, reach=1.2, lags=4, vertices=300, seed=2)
    ends = np.unique([pairs.first, pairs.second])
    assert len(ends) <= 300 and (np.abs(pairs.weights.sum(axis=1) - 1.0) < 1e-12).all()
    lengths = near_distances(BALL.mesh, 1.3).toarray()[pairs.first, pairs.second]
    assert np.bincount((lengths / 0.3).astype(int)).tolist()[2:] == [800, 800] and lengths.max() <= 1.2
    again = variogram_pairs(BALL.mesh, reach=1.2, lags=4, vertices=300, seed=2)
    np.testing.assert_array_equal(pairs.first, again.first)
    assert len(np.intersect1d(ends, np.unique(variogram_pairs(BALL.mesh, reach=1.2, vertices=300).first))) < 250
    with pytest.raises(ValueError, match="lags is 1 and vertices 1000, both must be 2"):
        variogram_pairs(BALL.mesh, reach=1.0, lags=1)
    with pytest.raises(ValueError, match=r"lag 0\.00\S* has pairs of weight"):
        variogram_pairs(BALL.mesh, reach=0.2, vertices=5)


def test_the_variogram_of_white_noise_is_its_variance_and_that_of_a_field_rises() -> None:
    np.testing.assert_allclose(PAIRS.of(WHITE), WHITE.var(), rtol=0.1)
    curves = PAIRS.of(SMOOTH)
    assert (curves[0] < 0.35 * curves[-1]).all() and curves.shape == (12, 3)


def test_a_line_is_fitted_without_negative_parts() -> None:
    x = np.array([1.0, 2.0, 3.0])
    found = np.column_stack([x, x, x])
    for wanted, slope, level in ((2 * x + 1, 2.0, 1.0), (2 * x - 1, 22 / 14, 0.0), (-x, 0.0, -2.0), (5 - x, 0.0, 3.0)):
        b, a, error = nonnegative_line(found, wanted)
        np.testing.assert_allclose(b, slope)
        np.testing.assert_allclose(a, level, atol=1e-12)
        np.testing.assert_allclose(error, ((slope * x + level - wanted) ** 2).sum(), atol=1e-12)


def test_nulls_of_a_field_have_its_variogram_and_permuted_ones_do_not() -> None:
    values = SMOOTH[:, 0] + 3.0
    nulls = MATCHING.nulls(values, 60, seed=1)
    assert nulls.shape == (COUNT, 60)
    assert np.median(variogram_error(PAIRS, values, nulls)) < 0.12
    shuffled = np.random.default_rng(0).permutation(values)[:, None]
    assert variogram_error(PAIRS, values, shuffled)[0] > 0.3
    np.testing.assert_allclose(nulls.mean(axis=0), values.mean(), rtol=1e-12)
    assert np.abs(np.asarray(np.corrcoef(nulls.T))[0, 1:]).mean() < 0.4
    assert np.abs(np.asarray(np.corrcoef(values, nulls.T))[0, 1:]).mean() < 0.4
    np.testing.assert_array_equal(MATCHING.nulls(values, 5, seed=3), MATCHING.nulls(values, 5, seed=3))


def test_nulls_of_white_noise_are_white() -> None:
    nulls = MATCHING.nulls(WHITE, 40)
    curves = PAIRS.of(nulls)
    np.testing.assert_allclose(curves.mean(axis=1), WHITE.var(), rtol=0.08)
    assert np.median(variogram_error(PAIRS, WHITE, nulls)) < 0.1


def test_the_same_kernel_at_all_vertices_and_at_those_of_the_pairs() -> None:
    """The variogram that a null was chosen by is that of the null, up to its noise: none is added to a very smooth map."""
    slow = BALL.mesh.vertices[:, 2]
    nulls = MATCHING.nulls(slow, 20, seed=2)
    assert np.median(variogram_error(PAIRS, slow, nulls)) < 0.25
    rough = (
        np.abs(np.diff(nulls[BALL.mesh.edges], axis=1)).mean() / np.abs(np.diff(slow[BALL.mesh.edges], axis=1)).mean()
    )
    assert rough < 2.5


def test_values_may_be_matched() -> None:
    nulls = MATCHING.nulls(SMOOTH[:, 0], 3, match_values=True)
    np.testing.assert_array_equal(np.sort(nulls, axis=0), np.tile(np.sort(SMOOTH[:, 0])[:, None], 3))
    assert values_error(SMOOTH[:, 0], nulls).max() == 0.0
    shifted = values_error(SMOOTH[:, 0], SMOOTH[:, :1] + 2.0 * SMOOTH[:, 0].std())
    np.testing.assert_allclose(shifted, 2.0)


def test_bad_input_is_refused() -> None:
    with pytest.raises(ValueError, match=r"neighbours have shape \(642, 200\) and distances \(642, 5\)"):
        VariogramMatching(NEAREST[0], NEAREST[1][:, :5], PAIRS)
    for fractions in ((), (0.001,), (0.5, 1.1)):
        with pytest.raises(ValueError, match="of 200 neighbours are kernels of"):
            VariogramMatching(*NEAREST, PAIRS, fractions)
    with pytest.raises(ValueError, match=r"map has shape \(5,\)"):
        MATCHING.nulls(WHITE[:5], 3)


def test_pairs_with_an_unknown_end_do_not_count() -> None:
    pairs = VariogramPairs(np.array([0, 1, 2]), np.array([1, 2, 3]), np.array([1.0]), np.array([[0.5, 0.25, 0.25]]))
    values = np.array([0.0, 2.0, 2.0, 6.0])
    assert pairs.of(values)[0] == 0.5 * 2.0 + 0.25 * 8.0
    null = np.array([np.nan, 0.0, 2.0, 4.0])[:, None]
    np.testing.assert_allclose(variogram_error(pairs, values, null), abs(2.0 - 3.0) / 3.0)


def test_the_error_of_a_variogram_is_a_root_mean_square_over_lags() -> None:
    lags = np.arange(1.0, 6.0)
    pairs = VariogramPairs(np.zeros(5, np.int64), np.arange(1, 6), lags, np.eye(5))
    values, null = np.array([0.0, 2.0, 2.0, 2.0, 2.0, 2.0]), np.array([0.0, 2.0, 2.0, 2.0, 2.0, 4.0])[:, None]
    # half the squares are 2 everywhere, and 8 at the last lag of the null
    np.testing.assert_allclose(variogram_error(pairs, values, null), np.sqrt(36.0 / 5.0) / 2.0)
    # over the mean of 2, 2, 2, 2 and 32, which is not their median
    np.testing.assert_allclose(
        variogram_error(pairs, np.append(values[:5], 8.0), values[:, None]), 30.0 / 8.0 / np.sqrt(5.0)
    )
