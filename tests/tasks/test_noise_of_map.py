"""What `noise` says of maps: of units, of masks, of two measurements, and of maps that are hardly maps."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import surfexp as sx
from surfexp.commands.command_line import main
from surfexp.operators.fem import fem
from surfexp.smoothing.methods import heat_time
from surfexp.variational.surface_flows import heat_flow

BALL = sx.shape("icosphere", levels=4)
OPERATOR = fem(BALL.mesh)
X, Y, Z = BALL.mesh.vertices.T
SMOOTH = np.sin(3.0 * X) + Y * Z
WHITE = 0.3 * np.random.default_rng(0).standard_normal(len(X))


def test_the_noise_of_a_map_has_its_unit() -> None:
    plain, scaled = sx.noise(BALL, SMOOTH + WHITE), sx.noise(BALL, 1e6 - 1e3 * (SMOOTH + WHITE))
    assert plain.level == pytest.approx(0.3, rel=0.1) and plain.kinds == ()
    assert scaled.level == pytest.approx(1e3 * plain.level, rel=1e-6) and scaled.kinds == ()


def test_outside_the_mask_nothing_is_known_and_outliers_keep_their_names() -> None:
    values = SMOOTH + WHITE
    values[np.flatnonzero(Z > 0)[:20]] += 9.0
    values[Z < -0.2] = np.nan
    found = sx.noise(BALL, values)
    assert np.array_equal(np.isnan(found.levels), Z < -0.2)
    assert np.isin(found.outliers, np.flatnonzero(Z > 0)[:20]).all() and len(found.outliers) >= 15
    assert "outliers" in found.kinds


def test_a_level_that_grows_is_followed() -> None:
    growth = 5.0 ** ((Y + 1.0) / 2.0)
    found = sx.noise(BALL, SMOOTH + growth * WHITE)
    assert found.kinds == ("varying",)
    assert np.abs(np.log(found.levels / (0.3 * growth))).mean() < 0.15


@pytest.mark.parametrize("width", [1.5, 3.0])
def test_a_second_measurement_tells_noise_that_is_smooth(width: float) -> None:
    def drawn(seed: int) -> np.ndarray:
        white = np.random.default_rng(seed).standard_normal(len(X))
        rough = heat_flow(OPERATOR, white, heat_time(width * OPERATOR.edge_length))
        return 0.4 * rough / rough.std()

    found = sx.noise(BALL, SMOOTH + drawn(1), SMOOTH + drawn(2))
    assert "smooth" in found.kinds and found.measurements == 2
    assert found.width == pytest.approx(width * OPERATOR.edge_length, rel=0.35)
    assert found.level == pytest.approx(0.4, rel=0.15)


def test_a_constant_map_has_no_noise() -> None:
    with pytest.raises(ValueError, match="constant at 2"):
        sx.noise(BALL, np.full(len(X), 2.0))


def test_a_value_that_means_no_data_is_refused() -> None:
    values = SMOOTH + WHITE
    values[7] = -9999.0
    with pytest.raises(ValueError, match="-9999 at vertex 7"):
        sx.noise(BALL, values)


def test_two_values_and_whole_numbers_are_rounded() -> None:
    for labels in ((Z > 0.1).astype(int), np.round(3.0 * SMOOTH).astype(int)):
        found = sx.noise(BALL, labels)
        assert found.kinds[0] == "rounded" and found.step == pytest.approx(1.0)
        assert 0.2 < found.level < 0.5


def test_zeros_on_most_of_the_surface_hide_no_noise() -> None:
    found = sx.noise(BALL, np.where(Z > 0.2, SMOOTH + WHITE, 0.0))
    assert found.kinds == ("partly constant",) and found.level == pytest.approx(0.3, rel=0.15)


def test_islands_of_nan_lie_outside() -> None:
    values = SMOOTH + WHITE
    values[np.random.default_rng(3).random(len(X)) < 0.05] = np.nan
    found = sx.noise(BALL, values)
    assert found.kinds == () and found.level == pytest.approx(0.3, rel=0.15)


def test_the_command_says_it_in_words_and_writes_the_level(
    working_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    values = SMOOTH + WHITE
    values[:60] += 9.0 * np.random.default_rng(4).choice([-1.0, 1.0], 60)
    sx.write("ball.vtk", sx.Surface(BALL.mesh, "ball", "mm", {"height": values}))
    assert main(["noise", "ball.vtk", "height"]) == 0
    said = capsys.readouterr().out
    assert "kind: outliers" in said and "values are outliers, far from those of all their neighbours" in said
    assert main(["noise", "ball.vtk", "height", "--to", "level.vtk"]) == 0
    assert json.loads(Path("level.vtk.json").read_text())["standard_deviation"] == pytest.approx(0.3, rel=0.1)


def test_a_text_says_that_noise_is_white_and_where_outliers_are() -> None:
    values = BALL.mesh.vertices[:, 2] + 0.1 * np.random.default_rng(0).standard_normal(len(BALL.mesh.vertices))
    assert "The noise is white: of one level" in str(sx.noise(BALL, values))
    values[100] = 9.0
    assert "Outliers are at vertices 100." in str(sx.noise(BALL, values))


@pytest.mark.parametrize("method", ["rof", "tgv", "auto"])
def test_noise_that_is_given_needs_no_surface_to_read_it_from(method: str) -> None:
    octahedron = sx.shape("icosphere", levels=0)
    small = octahedron.mesh.vertices, octahedron.mesh.faces[:8]
    kept = np.unique(small[1])
    small = small[0][kept], np.searchsorted(kept, small[1])
    values = small[0][:, 2] + 0.1 * np.random.default_rng(0).standard_normal(len(kept))
    with pytest.raises(ValueError, match="an estimate needs 20: give noise"):
        sx.denoise(small, values, method=method)
    found = sx.denoise(small, values, method=method, noise=0.1)
    assert found.certificate["noise"] == pytest.approx(0.1) and np.isfinite(found.values).all()
    path = sx.denoise_path(small, values, noise=0.1, weights=(0.1, 1.0), tolerance=1e-2)
    assert np.isfinite(path.risk([0.2, 0.5]).risks).all()


@pytest.mark.parametrize("power", [-120, 120])
def test_the_width_is_in_the_unit_of_the_surface_and_back(power: int) -> None:
    white = np.random.default_rng(0).standard_normal((2, len(X), 1))
    first, second = (heat_flow(OPERATOR, one, heat_time(3.0 * OPERATOR.edge_length))[:, 0] for one in white)
    other = 2.0**power * BALL.mesh.vertices, BALL.mesh.faces
    plain, scaled = sx.noise(BALL, first, second), sx.noise(other, first, second)
    assert plain.width > 0 and scaled.width == pytest.approx(2.0**power * plain.width, rel=1e-12, abs=0.0)
    weights = {"weights": (0.1, 1.0), "tolerance": 0.1}
    risks = [
        sx.denoise_path(where, first, noise=noise, **weights).risk([0.2, 0.5]).risks
        for where, noise in ((BALL, plain), (other, scaled))
    ]
    np.testing.assert_allclose(*risks, rtol=1e-6)
