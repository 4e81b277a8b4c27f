"""Corrections against counts by hand and scipy's Benjamini-Hochberg."""

import numpy as np
from scipy.stats import false_discovery_control

from surfexp.inference.corrections import false_discovery_rate, family_wise


def test_family_wise_p_by_hand() -> None:
    largest = np.array([3.0, 1.0, 2.0, 2.0 * (1.0 - 1e-12), 0.0])
    np.testing.assert_allclose(family_wise(np.array([0.0, 0.5, 2.0, 3.0, 2.5]), largest), [1.0, 0.8, 0.6, 0.2, 0.2])


def test_the_false_discovery_rate_is_scipys() -> None:
    p = np.random.default_rng(0).random(200) ** 3
    p[10:20] = p[0]
    np.testing.assert_allclose(false_discovery_rate(p), false_discovery_control(p), rtol=1e-14)
