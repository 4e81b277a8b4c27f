"""Two drums side by side."""

from __future__ import annotations

import numpy as np

from surfexp.mesh.shapes.isospectral_drum import GORDON_WEBB_WOLPERT, TILE_SHAPES
from surfexp_studies.drums.isospectral_comparison import compare_drums


def test_drums_side_by_side() -> None:
    found = compare_drums(GORDON_WEBB_WOLPERT, TILE_SHAPES["right_isosceles"], 10, 10)
    assert found.spectral_difference < 1e-12 and found.differing_modes[0] == 4
    assert found.outline_difference > 0.1
    one, two = eigen_values(found.first), eigen_values(found.second)
    assert np.array_equal(np.round(one, 9), np.round(two, 9))


def eigen_values(system) -> np.ndarray:
    return system.values
