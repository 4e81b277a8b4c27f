"""What a second measurement is good for: noise that is smooth is known, and filters are chosen for it."""

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
CLEAN = 2.0 * np.sign(Z) + X
LEVEL = 0.8


def measured(width: float, seed: int) -> np.ndarray:
    """The map with noise of a full width in edges."""
    noise = np.random.default_rng(seed).standard_normal(len(X))
    if width:
        noise = heat_flow(OPERATOR, noise, heat_time(width * OPERATOR.edge_length))
        noise /= np.sqrt(np.mean(noise**2))
    return CLEAN + LEVEL * noise


def error(values: np.ndarray) -> float:
    return float(OPERATOR.mass @ (values - CLEAN) ** 2 / OPERATOR.mass.sum())


FIRST, SECOND = measured(4.0, 1), measured(4.0, 2)
NOISE = sx.noise(BALL, FIRST, SECOND)


@pytest.mark.parametrize("width", [0.0, 1.5, 3.0, 4.0])
@pytest.mark.parametrize("seed", [1, 3, 5])
def test_the_level_is_the_planted_one_within_its_chance(width: float, seed: int) -> None:
    """A median has a deviation of 1.17 / sqrt(2 n) of the level, of as many values as are independent."""
    found = sx.noise(BALL, measured(width, seed), measured(width, seed + 1))
    alike = max(1.0, 1.31 * width**2)
    assert abs(found.level / LEVEL - 1.0) < 3.0 * 1.17 * np.sqrt(alike / (2 * len(X)))
    assert ("smooth" in found.kinds) == (width > 0.0) and not any("second measurement" in one for one in found.notes)


def test_filters_are_chosen_for_the_noise_that_is_known() -> None:
    alone, told = sx.denoise(BALL, FIRST), sx.denoise(BALL, FIRST, noise=NOISE)
    assert error(told.values) < 0.35 * error(alone.values)
    true, said = error(told.values) / NOISE.level**2, told.certificate
    assert abs(said["risk"] - true) < 3.0 * said["risk_error"] and said["noise"] == pytest.approx(NOISE.level)
    assert said["noise_kind"] == "smooth" and not said["noise_estimated"]


def test_a_path_takes_the_weight_that_suits_it() -> None:
    path = sx.denoise_path(BALL, FIRST, noise=NOISE, tolerance=1e-2)
    curve = path.risk()
    errors = np.array([error(path.at(float(weight)).values) for weight in curve.weights])
    assert errors[curve.best] < 1.3 * errors.min()
    alone = sx.denoise_path(BALL, FIRST, noise=NOISE.level, tolerance=1e-2).risk()
    assert alone.weight > 1.5 * curve.weight


def test_the_unit_and_the_mask_of_the_noise_are_those_of_the_map() -> None:
    first, second = (np.where(Z < -0.6, np.nan, one) for one in (FIRST, SECOND))
    plain = sx.denoise(BALL, first, noise=sx.noise(BALL, first, second))
    scaled = sx.denoise(BALL, 1e3 - 1e6 * first, noise=sx.noise(BALL, 1e3 - 1e6 * first, 1e3 - 1e6 * second))
    known = np.isfinite(plain.values)
    np.testing.assert_array_equal(known, Z >= -0.6)
    np.testing.assert_allclose((1e3 - scaled.values[known]) / 1e6, plain.values[known], atol=1e-3)
    with pytest.raises(ValueError, match="read it inside the same mask"):
        sx.denoise(BALL, FIRST, noise=sx.noise(BALL, first, second))


@pytest.mark.parametrize("offset", [0.0, 3.0])
def test_the_same_map_twice_is_refused(offset: float) -> None:
    with pytest.raises(ValueError, match=f"differs from the first by {offset:g} everywhere.*measured again") as refused:
        sx.noise(BALL, FIRST, FIRST + offset)
    assert "\n" not in str(refused.value)


def test_another_number_of_vertices_is_refused() -> None:
    with pytest.raises(ValueError, match="642"):
        sx.noise(BALL, FIRST, np.zeros(642))
    with pytest.raises(ValueError, match="2562 values, the map has 642"):
        sx.denoise(sx.shape("icosphere", levels=3), CLEAN[:642] + 0.1 * X[:642] ** 2, noise=NOISE)


def test_the_command_takes_a_second_file(working_folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name, values in (("first", FIRST), ("second", SECOND)):
        sx.write(f"{name}.shape.gii", values, BALL)
    sx.write("ball.surf.gii", BALL)
    asked = ["denoise", "ball.surf.gii", "first.shape.gii", "--second", "second.shape.gii", "--to", "clean.shape.gii"]
    assert main(asked) == 0
    facts = json.loads(Path("clean.shape.gii.json").read_text())
    assert facts["noise_kind"] == "smooth" and facts["noise"] == pytest.approx(NOISE.level, rel=1e-3)
    capsys.readouterr()
    assert main([*asked, "--noise", "0.3"]) == 2
    assert "give one of them" in capsys.readouterr().err
    assert main(["noise", "ball.surf.gii", "first.shape.gii", "--second", "first.shape.gii"]) == 2
    said = capsys.readouterr().err.strip()
    assert "it shows no noise" in said and len(said.splitlines()) == 1


@pytest.mark.parametrize("which", [0, 1])
def test_an_outlier_is_replaced_in_the_measurement_it_is_of(which: int) -> None:
    pair = [Z + 0.1 * np.random.default_rng(seed).standard_normal(len(Z)) for seed in (0, 1)]
    pair[which][7] += 5.0
    found = sx.noise(BALL, *pair)
    assert list(found.outliers) == [7]
    assert [list(sx.denoise(BALL, one, noise=found).outliers) for one in pair] == [[[7], []], [[], [7]]][which]
    assert not any("were replaced" in note for note in sx.denoise(BALL, pair[1 - which], noise=found).notes)
