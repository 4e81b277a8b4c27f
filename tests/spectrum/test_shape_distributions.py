"""Distributions over a surface: points are drawn by area."""

from __future__ import annotations

import numpy as np

from surfexp.spectrum.shape_distributions import _draw


def test_points_are_drawn_by_area_to_the_last_vertex() -> None:
    assert (_draw(np.array([0.0, 0.0, 1.0]), 0) == 2).all() and (_draw(np.array([1.0, 0.0, 0.0]), 0) == 0).all()
    weights = np.array([0.5, 0.1, 0.15, 0.25])
    drawn = _draw(weights, 1)
    np.testing.assert_allclose(np.bincount(drawn) / len(drawn), weights, atol=1.0 / len(drawn))
