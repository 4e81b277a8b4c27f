"""Distributions over a surface by hand: points by area, quantiles, and spectra of which every number is known."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.shape_distributions import (
    _draw,
    embedding_distances,
    heat_distribution,
    scaled_heat_trace,
    wave_distribution,
    weighted_quantiles,
)


def system(values: np.ndarray, vectors: np.ndarray, area: float) -> EigenSystem:
    return EigenSystem(values, vectors, np.zeros(len(values)), 0.0, True, area=area)


def test_points_are_drawn_by_area_to_the_last_vertex() -> None:
    assert (_draw(np.array([0.0, 0.0, 1.0]), 0) == 2).all() and (_draw(np.array([1.0, 0.0, 0.0]), 0) == 0).all()
    weights = np.array([0.5, 0.1, 0.15, 0.25])
    drawn = _draw(weights, 1)
    np.testing.assert_allclose(np.bincount(drawn) / len(drawn), weights, atol=1.0 / len(drawn))


def test_a_quantile_is_reached_in_the_middle_of_the_weight_of_its_point() -> None:
    """Of weights 1, 2, 1 in the order of values the middles are at 1/8, 1/2 and 7/8 of the whole."""
    values, weights = np.array([[3.0, 10.0], [1.0, 30.0], [2.0, 20.0]]), np.array([1.0, 1.0, 2.0])
    levels = np.array([0.05, 0.125, 0.3125, 0.5, 0.875, 0.95])
    expected = np.array([1.0, 1.0, 1.5, 2.0, 3.0, 3.0])
    np.testing.assert_allclose(weighted_quantiles(values, weights, levels), expected[:, None] * [1.0, 10.0])


@pytest.mark.parametrize("area", [0.7, 30.0])
def test_the_heat_trace_of_equidistant_eigenvalues_is_a_geometric_series(area: float) -> None:
    """Those of Weyl's density, 4 pi (n + 1/2) / area, of which the first 200 and the tail make up the whole."""
    values = 4.0 * np.pi / area * (np.arange(200) + 0.5)
    times = np.geomspace(0.004, 0.4, 12)
    found = scaled_heat_trace(system(values, np.empty((1, 200)), area))
    np.testing.assert_allclose(found, -np.log(2.0 * np.sinh(times / 2.0)), atol=1e-6)


def test_where_all_points_are_equal_every_quantile_of_heat_is_the_trace() -> None:
    area, values = 3.0, np.array([0.0, 1.0, 2.5, 4.0])
    vectors = np.array([[1, 1, 1, 1], [1, -1, 1, -1], [1, 1, -1, -1], [1, -1, -1, 1]]) / np.sqrt(area)
    times = np.geomspace(0.004, 0.4, 12)[4:] * area / (4.0 * np.pi)
    trace = np.log(np.exp(-np.multiply.outer(values, times)).sum(axis=0))
    found = heat_distribution(system(values, vectors, area), np.array([1.0, 2.0, 3.0, 4.0]))
    np.testing.assert_allclose(found.reshape(5, 8), np.tile(trace, (5, 1)), rtol=1e-12)


def test_a_band_of_wave_quantiles_by_hand() -> None:
    """Two modes, 16 bands a fifteenth of the way between them apart, a width of two: the eighth is seven and eight off."""
    area = 3.0
    found = wave_distribution(system(np.array([2.0, 5.0]), np.eye(2), area), np.ones(2)).reshape(5, 16)[:, 7]
    near, far = np.exp([-(7.0**2) / 8.0, -(8.0**2) / 8.0]) / np.exp([-(7.0**2) / 8.0, -(8.0**2) / 8.0]).sum()
    # two equal points are reached at a quarter and three quarters
    expected = [far, far + 0.1 * (near - far), 0.5, near - 0.1 * (near - far), near]
    np.testing.assert_allclose(found, area * np.array(expected), rtol=1e-12)


def test_distances_of_two_places_are_none_and_one_over_the_root_of_their_share() -> None:
    """Half of 400 points lie at each: 40,000 of 79,800 pairs are apart, in units of the root of the mean square."""
    vectors = np.array([[1.0, 1.0], [1.0, -1.0]])
    found = embedding_distances(system(np.array([0.0, 7.0]), vectors, 2.0), np.ones(2))
    share = 40_000 / 79_800
    expected = np.zeros(40)
    expected[0], expected[int(share**-0.5 / 0.075)] = 1.0 - share, share
    np.testing.assert_allclose(found, expected, rtol=1e-12)
