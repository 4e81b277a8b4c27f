"""The ROF model at every weight: the proved gap against independent solves, exact solutions, units."""

from __future__ import annotations

import numpy as np
import pytest

import surfexp as sx
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.calculus import total_variation
from surfexp.operators.fem import fem
from surfexp.variational.rof_path import rof_path
from surfexp.variational.separable_quadratic import rof
from surfexp.variational.solvers.newton import newton

MESH = icosphere(3).mesh
OPERATOR = fem(MESH)
RNG = np.random.default_rng(0)
MAP = np.sign(MESH.vertices[:, 2]) + 0.5 * MESH.vertices[:, 0] + 0.3 * RNG.standard_normal(642)
LEAST, MOST = 0.5, 500.0


@pytest.fixture(scope="module")
def path():
    return rof_path(OPERATOR, MAP, LEAST, MOST, tolerance=1e-3)


@pytest.mark.slow
def test_the_gap_holds_at_200_weights_between_those_solved(path) -> None:
    """No interpolated map has more energy above the minimum, by Newton's method to 1e-8, than it proves."""
    assert path.largest_gap <= 1e-3 and len(path.knots) <= 40
    weights = np.exp(np.random.default_rng(1).uniform(np.log(LEAST), np.log(MOST), 200))
    for mu in weights:
        found = path.at(float(mu))
        data = rof(OPERATOR.mass, MAP, float(mu))
        exact = newton(data, OPERATOR, tolerance=1e-8)
        assert found.energy == pytest.approx(
            total_variation(OPERATOR, found.values) + data.value(found.values), rel=1e-9
        )
        assert found.lower_bound <= exact.energy * (1.0 + 1e-8)
        assert (found.energy - exact.lower_bound) / found.energy <= path.largest_gap + 1e-8
        assert found.relative_gap <= path.largest_gap * (1.0 + 1e-9)
        distance = np.sqrt(OPERATOR.mass @ (found.values - exact.values) ** 2)
        assert distance <= found.error_bound + exact.error_bound


def test_a_map_of_one_height_shrinks_as_the_formula_says() -> None:
    """A minimiser below the critical weight is the mean of the map: there the dual field holds all of it."""
    path = rof_path(OPERATOR, MAP, 1e-3, 1e-2, tolerance=1e-4)
    mean = OPERATOR.mass @ MAP / OPERATOR.mass.sum()
    np.testing.assert_allclose(path.at(5e-3).values, mean, atol=1e-6)


@pytest.mark.parametrize(("factor", "offset"), [(1e-6, 0.0), (1e6, 3.0), (-1.0, 1e3)])
def test_units_change_nothing(path, factor: float, offset: float) -> None:
    other = rof_path(OPERATOR, factor * MAP + offset, LEAST / abs(factor), MOST / abs(factor), tolerance=1e-3)
    assert other.largest_gap == pytest.approx(path.largest_gap, rel=1e-3)
    values = (other.at(7.0 / abs(factor)).values - offset) / factor
    np.testing.assert_allclose(values, path.at(7.0).values, atol=2e-4)


def test_several_channels_have_one_path() -> None:
    both = np.stack([MAP, MESH.vertices[:, 1]], axis=1)
    path = rof_path(OPERATOR, both, 5.0, 50.0, tolerance=1e-2)
    assert path.largest_gap <= 1e-2 and path.at(20.0).values.shape == both.shape


def test_the_face_keeps_mask_and_weights_of_denoise() -> None:
    sphere = sx.shape("icosphere", levels=3)
    holed = np.where(np.arange(642) < 20, np.nan, MAP)
    path = sx.denoise_path(sphere, holed, noise=0.3)
    one = path.at(0.9)
    plain = sx.denoise(sphere, holed, method="rof", noise=0.3, tolerance=1e-7)
    assert np.isnan(one.values).sum() == 20
    distance = np.sqrt(np.nanmean((one.values - plain.values) ** 2))
    assert distance < 2.0 * (one.certificate["error_bound"] + plain.certificate["error_bound"])
    assert "every weight" in repr(path)
    with pytest.raises(ValueError, match=r"weight = 31 is outside of the path, choose one from 0.03 to 30"):
        path.at(31)
    with pytest.raises(ValueError, match="is no range"):
        sx.denoise_path(sphere, MAP, weights=(2.0, 1.0))
    with pytest.raises(ValueError, match="constant"):
        sx.denoise_path(sphere, np.ones(642))


def test_a_tolerance_that_takes_too_many_solves_is_refused_after_the_first_of_them() -> None:
    counts: list[int] = []
    with pytest.raises(
        ValueError, match=r"^32 solves leave .*, tolerance = 1e-06 needs about \d+, at most 400 are done: take"
    ):
        rof_path(OPERATOR, MAP, LEAST, MOST, tolerance=1e-6, progress=lambda count, gap: counts.append(count))
    assert counts[-1] == 32
    assert len(rof_path(OPERATOR, MAP, 10.0, 10.5, tolerance=1e-6).knots) < 32
