"""The risk along a path of the ROF model: exact where the minimiser is known, right in the mean, of the map it is said of."""

from __future__ import annotations

import numpy as np
import pytest

import surfexp as sx
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.fem import fem
from surfexp.smoothing.parameter_choice import smooth_on_grid
from surfexp.smoothing.path_risk import path_risk
from surfexp.variational.rof_path import rof_path
from surfexp.variational.separable_quadratic import rof
from surfexp.variational.solvers.newton import newton

SPHERE = sx.shape("icosphere", levels=3)
OPERATOR = fem(SPHERE.mesh)
AREA = OPERATOR.mass / OPERATOR.mass.sum()
X, Y, Z = SPHERE.mesh.vertices.T
CLEAN = 2.0 * np.sign(Z) + X
LEVEL = 0.8


def noisy(seed: int, clean: np.ndarray = CLEAN) -> np.ndarray:
    return clean + LEVEL * np.random.default_rng(seed).standard_normal(len(clean))


@pytest.fixture(scope="module")
def path() -> sx.tasks.denoising_path.DenoisingPath:
    return sx.denoise_path(SPHERE, noisy(0), noise=LEVEL)


def test_below_the_critical_weight_the_risk_is_that_of_the_mean() -> None:
    """There the minimiser is the mean of the map, and its response that of the mean to the probe."""
    image = noisy(1)
    found = path_risk(rof_path(OPERATOR, image, 1e-3, 1e-2), LEVEL)
    mean = AREA @ image
    expected = AREA @ (mean - image) ** 2 / LEVEL**2 - 1.0
    assert found.noise.kinds == () and not len(found.noise.outliers)
    probe = found.noise.draw(OPERATOR, 0) / found.noise.level
    for mu in (1e-3, 4e-3, 1e-2):
        assert found.at(mu)[0] == pytest.approx(expected + 2.0 * (AREA @ probe) ** 2, abs=1e-4)


def test_where_the_map_is_kept_the_risk_is_the_variance_of_the_noise() -> None:
    found = path_risk(rof_path(OPERATOR, noisy(1), 1e6, 1e7), LEVEL)
    assert found.at(3e6)[0] == pytest.approx(1.0, abs=1e-2)


def test_at_a_solved_weight_it_is_the_estimate_of_parameter_choice(path) -> None:
    """Another code with the same signs, by Newton's method to 1e-10."""
    image, inner = noisy(0), path._path
    mus = inner.mus[::6]

    def smoother(columns: np.ndarray, mu: float) -> np.ndarray:
        found = [newton(rof(OPERATOR.mass, column, mu), OPERATOR, tolerance=1e-10).values for column in columns.T]
        return np.column_stack(found)

    # the probe of a path starts from the sign of the map's first value
    sign = np.sign(inner.own.normalised(image)[0])
    grid = smooth_on_grid(smoother, sign * image[:, None], mus.tolist(), OPERATOR.mass, LEVEL)
    np.testing.assert_allclose(path.risk(path.weights[::6]).risks, grid.stein / LEVEL**2, atol=0.02)


@pytest.mark.slow
def test_its_mean_over_draws_is_the_mean_square_error() -> None:
    """Of 40 maps with noise the estimates differ from the errors by chance alone, of which their standard errors are bounds.

    Where a weight leaves much of the noise the step of the probe adds to the estimate: .024 here, .001 for a third of the step.
    """
    apart, said = [], []
    for seed in range(40):
        path = sx.denoise_path(SPHERE, noisy(seed), noise=LEVEL, weights=(0.2, 5.0))
        curve = path.risk([0.3, 0.9, 2.5])
        errors = [AREA @ (path.at(weight).values - CLEAN) ** 2 / LEVEL**2 for weight in curve.weights]
        apart.append(curve.risks - errors)
        said.append(curve.errors)
    spread = np.std(apart, axis=0)
    bias = np.abs(np.mean(apart, axis=0))
    assert (bias < 3.0 * spread / np.sqrt(40) + [0.0, 0.0, 0.02]).all()
    assert (spread < np.mean(said, axis=0)).all() and (np.mean(said, axis=0) < 2.2 * spread).all()


def test_the_weight_of_the_least_is_nearly_the_best_there_is(path) -> None:
    curve = path.risk()
    errors = np.array([AREA @ (path.at(weight).values - CLEAN) ** 2 for weight in curve.weights])
    assert len(curve.weights) == 61 and curve.weights[0] == 0.03 and curve.weights[-1] == 30.0
    assert curve.risks[curve.best] == curve.risks.min() and curve.weights[curve.best] == curve.weight
    assert errors[curve.best] < 1.15 * errors.min() and errors.max() > 10.0 * errors.min()
    assert curve.notes == () and "weight of the least" in repr(curve)


@pytest.mark.parametrize(("factor", "offset"), [(1e-150, 0.0), (1e6, 1e7), (-1.0, 3.0)])
def test_units_and_signs_change_nothing(path, factor: float, offset: float) -> None:
    other = sx.denoise_path(SPHERE, factor * noisy(0) + offset, noise=LEVEL * abs(factor))
    weights = [0.05, 0.4, 1.0, 7.0]
    np.testing.assert_allclose(other.risk(weights).risks, path.risk(weights).risks, atol=0.01)


def test_outside_the_mask_and_at_outliers_nothing_is_estimated() -> None:
    image = noisy(2)
    holed = np.where(Z < -0.9, np.nan, image)
    spoiled = np.where(np.arange(len(Z)) % 160 == 7, image + 60.0, image)
    weights = [0.2, 0.5, 1.0, 2.0]
    plain = sx.denoise_path(SPHERE, image, noise=LEVEL).risk(weights).risks
    assert np.abs(sx.denoise_path(SPHERE, holed, noise=LEVEL).risk(weights).risks - plain).max() < 0.15
    assert np.abs(sx.denoise_path(SPHERE, spoiled, noise=LEVEL).risk(weights).risks - plain).max() < 0.4


def test_what_cannot_hold_is_said() -> None:
    heavy = CLEAN + np.random.default_rng(3).laplace(0.0, 0.8, len(Z))
    assert any("heavy tails" in note for note in sx.denoise_path(SPHERE, heavy).risk().notes)
    ends = sx.denoise_path(SPHERE, noisy(0), noise=LEVEL, weights=(3.0, 9.0)).risk()
    assert ends.weight == 3.0 and "at an end of the range, 3" in ends.notes[0]


def test_weights_that_are_none_are_refused(path) -> None:
    for wrong, said in (([31.0], "outside of the path"), ([2.0, 1.0], "that grow"), ([], "that grow")):
        with pytest.raises(ValueError, match=said):
            path.risk(wrong)
    colours = sx.denoise_path(SPHERE, np.column_stack([X, Y, noisy(0)]), noise=0.5, weights=(0.5, 1.0), tolerance=0.1)
    with pytest.raises(ValueError, match="has 3: give each by itself"):
        colours.risk()


def test_a_plot_marks_the_least(path, tmp_path) -> None:
    curve = path.risk()
    picture = curve.plot(width=600)
    assert picture.figure.pixels.shape == (372, 600, 3)
    orange = np.argwhere((picture.figure.pixels.astype(int) - (213, 94, 0) == 0).all(axis=2))[:, 1]
    marked = np.bincount(orange).argmax()
    blue = np.argwhere((picture.figure.pixels.astype(int) - (0, 114, 178) == 0).all(axis=2))
    lowest = blue[np.argmax(blue[blue[:, 1] < 540, 0])]
    assert abs(marked - lowest[1]) < 12
    for name in ("risk.png", "risk.svg"):
        picture.save(tmp_path / name)
        assert (tmp_path / name).stat().st_size > 5000


def test_a_finer_mesh_has_the_same_curve() -> None:
    mesh = icosphere(4).mesh
    clean = 2.0 * np.sign(mesh.vertices[:, 2]) + mesh.vertices[:, 0]
    image = clean + LEVEL * np.random.default_rng(5).standard_normal(len(clean))
    curve = sx.denoise_path((mesh.vertices, mesh.faces), image, noise=LEVEL).risk()
    assert curve.errors[curve.best] < 0.06 and -0.1 < curve.risks[curve.best] < 0.2 and 0.3 < curve.weight < 2.0
