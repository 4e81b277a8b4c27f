"""Extrapolated eigenvalues of drums against published and exact ones."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.mesh.shapes.isospectral_drum import GORDON_WEBB_WOLPERT, TILE_SHAPES
from surfexp_studies.drums.drum_elements import GORDON_WEBB_WOLPERT_VALUES
from surfexp_studies.drums.drum_values import drum_values, extrapolated

TILE = TILE_SHAPES["right_isosceles"]
KNOWN = np.array(GORDON_WEBB_WOLPERT_VALUES)


def test_extrapolation_is_exact_on_its_model() -> None:
    n = np.array([4.0, 6.0, 8.0])
    limits = np.array([1.0, 5.0])
    computed = limits + np.outer(n**-6.0, [3.0, -2.0]) + np.outer(n**-8.0, [1.0, 7.0])
    assert extrapolated((4, 6, 8), computed, (6.0, 8.0)) == pytest.approx(limits, rel=1e-12)


def test_values_of_the_drum_on_small_meshes() -> None:
    found = drum_values(GORDON_WEBB_WOLPERT.first, TILE, 10, (12, 16, 20))
    error = np.abs(found.values / KNOWN - 1.0)
    assert error.max() < 5e-6 and (found.computed > KNOWN).all()
    assert (np.abs(found.computed[-1] / KNOWN - 1.0) > 4.0 * error).mean() > 0.8
    assert (error <= 10.0 * found.estimates + 1e-9).all()
    same = drum_values(GORDON_WEBB_WOLPERT.second, TILE, 10, (12, 16, 20))
    assert same.values == pytest.approx(found.values, rel=1e-10)


@pytest.mark.slow
def test_stretch_of_the_drum() -> None:
    found = drum_values(GORDON_WEBB_WOLPERT.first, TILE)
    assert np.abs(found.values[:10] / KNOWN - 1.0).max() < 1e-9
    exact = 1.25 * np.pi**2 * np.array([1.0, 2.0])
    assert found.values[[8, 20]] == pytest.approx(exact, rel=1e-8)
    assert found.estimates.max() < 2e-8


@pytest.mark.parametrize("bad", [(8, 12), (8, 12, 13), (8, 16, 12)])
def test_unfit_divisions_are_refused(bad: tuple[int, ...]) -> None:
    with pytest.raises(ValueError, match="at least 3 even numbers, increasing"):
        drum_values(GORDON_WEBB_WOLPERT.first, TILE, divisions=bad)
