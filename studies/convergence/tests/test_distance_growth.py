"""How the spectral distance grows with the number of eigenfunctions."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.embedding.analytic_spectra import sphere_embedding, spheroid_embedding, torus_embedding
from surfexp.embedding.spectral_distance import spectral_distance
from surfexp_studies.convergence.distance_growth import distance_brackets, logarithmic_slope, squared_norms


def test_the_norm_grows_by_a_quarter_over_pi_with_the_logarithm() -> None:
    sizes = [25, 50, 100, 200, 400]
    for embedding in (torus_embedding(1.1, 400, 12), spheroid_embedding(0.8, 400, 20, 20), sphere_embedding(440, 200)):
        assert 4 * np.pi * logarithmic_slope(sizes, squared_norms(embedding, sizes)) == pytest.approx(1.0, abs=0.05)
    tame = torus_embedding(1.1, 400, 12, "biharmonic")
    norms = squared_norms(tame, sizes)
    assert norms[-1] / norms[-2] < 1.01


def test_brackets_hold_the_distance() -> None:
    first, second = torus_embedding(1.3, 8, 16), torus_embedding(1.5, 8, 16)
    lower, upper = distance_brackets(first, second, [2, 4, 8])
    assert (lower <= upper + 1e-12).all()
    best = spectral_distance(first.truncated(4), second.truncated(4)).value
    assert lower[1] <= best <= upper[1] + 1e-12
