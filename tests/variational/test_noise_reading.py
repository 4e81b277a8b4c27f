"""The noise that is read from a map: ties, zeros, outliers, and how often white noise raises a false alarm."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.fem import fem
from surfexp.variational.noise_correlation import WIDTHS, correlation, growth_of_noise
from surfexp.variational.noise_level import noise_level
from surfexp.variational.noise_reading import read_noise
from surfexp.variational.noise_statistics import NoiseStatistics

MESH = icosphere(4).mesh
OPERATOR = fem(MESH)
X, Y, Z = MESH.vertices.T
SMOOTH, PIECEWISE = np.sin(3.0 * X) + Y * Z, 2.0 * (Z > 0.2) + (X > 0.5)
CENTRES = np.random.default_rng(5).standard_normal((40, 3))
PATCHES = np.random.default_rng(6).standard_normal(40)[cKDTree(CENTRES).query(MESH.vertices)[1]]
MAPS = {"smooth": SMOOTH, "piecewise": PIECEWISE, "patches": PATCHES}


@pytest.mark.parametrize(
    ("name", "share"),
    [
        pytest.param(name, share, marks=() if (name, share) == ("smooth", 0.3) else pytest.mark.slow)
        for name in MAPS
        for share in (0.1, 0.3, 1.0)
    ],
)
def test_white_noise_raises_at_most_one_false_alarm_in_twenty(name: str, share: float) -> None:
    alarms = 0
    for seed in range(20):
        noise = share * MAPS[name].std() * np.random.default_rng(seed).standard_normal(len(X))
        found = read_noise(OPERATOR, MAPS[name] + noise)
        alarms += bool(found.notes)
        assert found.level == pytest.approx(noise_level(OPERATOR, MAPS[name] + noise), rel=1e-12)
    assert alarms <= 1


@pytest.mark.parametrize("width", [1.5, 2.0, 2.5])
def test_levels_of_smooth_noise_alone_tell_its_width_and_level(width: float) -> None:
    squares = growth_of_noise(OPERATOR)[WIDTHS.index(width)]
    for noise_alone in (False, True):
        found = correlation(NoiseStatistics(OPERATOR), squares, noise_alone)
        assert found.width == width and found.level_ratio == pytest.approx(np.sqrt(squares[0]))


def test_levels_of_a_part_are_those_of_its_noise() -> None:
    white = np.random.default_rng(0).standard_normal(len(X))
    there = Z > 0
    levels = NoiseStatistics(OPERATOR).ring_medians(np.where(there, 1.0, 50.0) * white, there & (Z > 0.5))
    assert levels == pytest.approx(np.ones(5), rel=0.15)


def test_noise_of_no_other_kind_is_white() -> None:
    values = SMOOTH + 0.3 * SMOOTH.std() * np.random.default_rng(0).standard_normal(len(X))
    assert read_noise(OPERATOR, values).facts["kind"] == "white"
    values[:40] += 20.0
    assert read_noise(OPERATOR, values).facts["kind"].startswith("outliers")


@pytest.mark.parametrize("name", MAPS)
def test_outliers_are_found_and_counted(name: str) -> None:
    rng = np.random.default_rng(0)
    sigma = 0.2 * MAPS[name].std()
    values = MAPS[name] + sigma * rng.standard_normal(len(X))
    bad = rng.choice(len(X), len(X) // 50, replace=False)
    values[bad] += 12.0 * sigma * rng.choice([-1.0, 1.0], len(bad))
    found = read_noise(OPERATOR, values)
    assert np.isin(bad, found.outliers).mean() > 0.8 and np.isin(found.outliers, bad).mean() > 0.8
    assert f"{len(found.outliers)} of {len(X)} values are outliers" in found.notes[0]


@pytest.mark.parametrize("sigma", [0.02, 0.05, 0.2])
def test_rounding_hides_no_noise(sigma: float) -> None:
    rough = SMOOTH + sigma * np.random.default_rng(0).standard_normal(len(X))
    found = read_noise(OPERATOR, np.round(rough, 1))
    # at twice the step few values are tied, and rounding is part of the noise
    assert found.step == pytest.approx(0.1 if sigma < 0.2 else 0.0)
    assert found.level == pytest.approx(np.hypot(sigma, 0.1 / np.sqrt(12.0)), rel=0.15)
    assert any("rounded to steps of 0.1" in note for note in found.notes) == (sigma < 0.2)


def test_labels_are_rounded_to_whole_numbers() -> None:
    found = read_noise(OPERATOR, PIECEWISE)
    assert found.step == 1.0 and 0.2 < found.level < 0.4 and "Labels" in found.notes[0]


def test_zeros_do_not_count_as_noise_of_zero() -> None:
    values = np.where(Z > 0.2, SMOOTH + 0.1 * np.random.default_rng(0).standard_normal(len(X)), 0.0)
    assert noise_level(OPERATOR, values) < 1e-12
    found = read_noise(OPERATOR, values)
    assert found.level == pytest.approx(0.1, rel=0.2) and "58 % of the surface" in found.notes[0]
    assert found.step == 0.0


@pytest.mark.parametrize("share", [0.2, 0.6, 0.9])
def test_many_zeros_are_no_rounding(share: float) -> None:
    rng = np.random.default_rng(1)
    values = np.where(rng.random(len(X)) < share, 0.0, SMOOTH + 0.3 * rng.standard_normal(len(X)))
    found = read_noise(OPERATOR, values)
    assert found.step == 0.0 and not any("rounded" in note for note in found.notes)


def test_a_map_that_is_clipped_at_both_ends_is_not_rounded() -> None:
    rough = SMOOTH + 0.3 * np.random.default_rng(2).standard_normal(len(X))
    found = read_noise(OPERATOR, np.clip(rough, *np.quantile(rough, [0.35, 0.65])))
    assert found.step == 0.0
