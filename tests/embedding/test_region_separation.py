"""Regions of two surfaces in one space."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.embedding.region_separation import region_separation


def test_shifted_copies_have_the_shift_within_and_the_spacing_between() -> None:
    corners = np.array([[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]])
    points = np.repeat(corners, 2, axis=0) + np.tile([[0.1, 0.0], [-0.1, 0.0]], (3, 1))
    labels, weights = np.repeat([0, 1, 2], 2), np.full(6, 1.0 / 6.0)
    order = np.random.default_rng(0).permutation(6)
    found = region_separation(points, weights, labels, points[order] + [0.0, 0.5], weights, labels[order])
    assert (found.between, found.within, found.found) == (pytest.approx(4.0), pytest.approx(0.5), 1.0)
    swapped = region_separation(points, weights, labels, points, weights, np.repeat([1, 2, 0], 2))
    assert swapped.found == 0.0


def test_regions_of_the_first_are_sought_among_those_of_the_second() -> None:
    first, second = np.array([[0.0], [10.0]]), np.array([[1.0], [4.0]])
    for one, other, share, between in ((first, second, 1.0, 10.0), (second, first, 0.5, 3.0)):
        found = region_separation(one, np.ones(2), np.arange(2), other, np.ones(2), np.arange(2))
        assert (found.found, found.between, found.within) == (share, between, 3.5)


def test_centres_are_weighted_and_foreign_labels_left_out() -> None:
    points, labels = np.array([[0.0], [1.0], [9.0], [50.0]]), np.array([0, 0, 1, -1])
    other = region_separation(
        points, np.array([3.0, 1.0, 1.0, 1.0]), labels, points, np.ones(4), np.array([0, 0, 1, 7])
    )
    assert other.between == pytest.approx(8.75) and other.within == pytest.approx(0.125)
    with pytest.raises(ValueError, match="1 labelled regions in common, at least 2 are needed"):
        region_separation(points, np.ones(4), labels, points, np.ones(4), np.array([0, 5, 5, 5]))
