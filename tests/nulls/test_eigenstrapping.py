"""Rotated coefficients keep power and mean, are uniform, and give an exact test where the map is isotropic in each group."""

import numpy as np
import pytest
from scipy.stats import kstest, special_ortho_group

import surfexp as sx
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.nulls.eigenstrapping import eigenstrapped, group_edges, group_powers, rotated_coefficients
from surfexp.nulls.kept import power_error
from surfexp.nulls.rejection import correlations, p_values
from surfexp.operators.assembly import mass_matrix
from surfexp.operators.fem import fem

BALL = icosphere(3)
AREAS = fem(BALL.mesh).mass
MASS = mass_matrix(fem(BALL.mesh))
MODES = sx.eigenpairs(BALL, 30).vectors
VALUES = np.random.default_rng(0).standard_normal(len(MODES)) + 2.0


def test_groups_are_those_of_a_sphere() -> None:
    assert group_edges(1).tolist() == [0, 1]
    assert group_edges(9).tolist() == [0, 1, 4, 9]
    assert group_edges(10).tolist() == [0, 1, 4, 9, 10]
    assert group_edges(30).tolist() == [0, 1, 4, 9, 16, 25, 30]


def test_power_and_mean_are_kept_to_rounding_and_nulls_lie_in_the_modes() -> None:
    nulls = eigenstrapped(MODES, MASS, VALUES, 50)
    wanted = group_powers(MODES, MASS, VALUES[:, None])
    np.testing.assert_allclose(np.sqrt(group_powers(MODES, MASS, nulls) / wanted), 1.0, rtol=1e-12)
    area = MASS.sum()
    np.testing.assert_allclose((MASS @ nulls).sum(axis=0) / area, (MASS @ VALUES).sum() / area, rtol=1e-12)
    np.testing.assert_allclose(MODES @ (MODES.T @ (MASS @ nulls)), nulls, atol=1e-12)
    assert power_error(MODES, MASS, VALUES, nulls).max() < 1e-12
    assert np.abs(np.corrcoef(nulls[:, 0], nulls[:, 1])[0, 1]) < 0.9


def test_seed_and_number_of_nulls() -> None:
    nulls = eigenstrapped(MODES, MASS, VALUES, 3, seed=5)
    assert nulls.shape == (len(MODES), 3)
    np.testing.assert_array_equal(nulls, eigenstrapped(MODES, MASS, VALUES, 3, seed=5))
    assert not np.allclose(nulls, eigenstrapped(MODES, MASS, VALUES, 3, seed=6))


@pytest.mark.parametrize("start", [1, 4])
def test_turned_vectors_are_distributed_as_by_haar_rotations(start: int) -> None:
    """Against scipy's rotations, and by moments: E u = 0, E u u^T = I / m, E u^4 = 3 / (m (m + 2))."""
    stop = {1: 4, 4: 9}[start]
    coefficients = np.arange(1.0, 10.0)
    turned = rotated_coefficients(coefficients, 20000, np.random.default_rng(1))
    assert (turned[0] == 1.0).all()
    length, size = np.linalg.norm(coefficients[start:stop]), stop - start
    units = turned[start:stop] / length
    np.testing.assert_allclose(np.linalg.norm(units, axis=0), 1.0, rtol=1e-14)
    np.testing.assert_allclose(units.mean(axis=1), 0.0, atol=0.02)
    np.testing.assert_allclose(units @ units.T / 20000, np.eye(size) / size, atol=0.012)
    np.testing.assert_allclose((units**4).mean(axis=1), 3.0 / (size * (size + 2.0)), atol=0.008)
    haar = special_ortho_group.rvs(size, size=2000, random_state=2) @ coefficients[start:stop]
    for k in range(size):
        assert kstest(turned[start + k, :2000], haar[:, k]).pvalue > 1e-3
    other = rotated_coefficients(coefficients, 20000, np.random.default_rng(1))[5 - start]
    assert np.abs(np.corrcoef(other, units[0])[0, 1]) < 0.02


def test_the_rest_is_left_out_or_has_its_values_in_another_order() -> None:
    rest = VALUES - MODES @ (MODES.T @ (MASS @ VALUES))
    nulls = eigenstrapped(MODES, MASS, VALUES, 4, rest="permute", seed=3)
    within = eigenstrapped(MODES, MASS, VALUES, 4, seed=3)
    np.testing.assert_allclose(np.sort(nulls - within, axis=0), np.tile(np.sort(rest)[:, None], 4), atol=1e-12)
    assert not np.allclose((nulls - within)[:, 0], rest) and not np.allclose(
        (nulls - within)[:, 0], (nulls - within)[:, 1]
    )
    matched = eigenstrapped(MODES, MASS, VALUES, 4, match_values=True, seed=3)
    np.testing.assert_array_equal(np.sort(matched, axis=0), np.tile(np.sort(VALUES)[:, None], 4))
    np.testing.assert_array_equal(np.argsort(matched, axis=0), np.argsort(within, axis=0))


def test_the_test_is_exact_for_maps_that_are_isotropic_in_each_group() -> None:
    random = np.random.default_rng(8)
    scales = np.repeat([0.0, 3.0, 2.0, 1.0, 0.5], [1, 3, 5, 7, 9])
    other = MODES[:, :25] @ (scales * random.standard_normal(25))
    rejected = []
    for k in range(600):
        values = MODES[:, :25] @ (scales * random.standard_normal(25))
        nulls = eigenstrapped(MODES, MASS, values, 19, seed=k)
        null = correlations(nulls, other[:, None], AREAS)
        rejected.append(p_values(correlations(values[:, None], other[:, None], AREAS)[0], null)[0] <= 0.05)
    # 5 % of 600, within three deviations
    assert abs(np.mean(rejected) - 0.05) < 3.0 * np.sqrt(0.05 * 0.95 / 600)


def test_what_cannot_be_rotated_is_refused() -> None:
    with pytest.raises(ValueError, match=r"map has shape \(3,\), expected \(642,\)"):
        eigenstrapped(MODES, MASS, np.zeros(3), 5)
    hole = VALUES.copy()
    hole[:7] = np.nan
    with pytest.raises(ValueError, match="7 values of 642 that are not finite: cut the surface"):
        eigenstrapped(MODES, MASS, hole, 5)
    with pytest.raises(ValueError, match=r"count is 0, must be in 1\.\.1000000"):
        eigenstrapped(MODES, MASS, VALUES, 0)
    with pytest.raises(ValueError, match="rest is 'keep', choose drop or permute"):
        eigenstrapped(MODES, MASS, VALUES, 5, rest="keep")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="orthonormal to 3"):
        eigenstrapped(2.0 * MODES, MASS, VALUES, 5)
    with pytest.raises(ValueError, match=r"first mode varies by"):
        eigenstrapped(MODES[:, 1:], MASS, VALUES, 5)
    with pytest.raises(ValueError, match=r"modes have shape \(642, 0\)"):
        eigenstrapped(MODES[:, :0], MASS, VALUES, 5)
