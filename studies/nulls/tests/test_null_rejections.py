"""The study of null models on a small sphere: shapes, identities, and planted correlations."""

from dataclasses import replace

import numpy as np
import pytest

import surfexp as sx
from surfexp.contract.member import Member
from surfexp.mesh.masked_surface import cut_to_mask
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.nulls.fields import gaussian_fields
from surfexp.nulls.rejection import correlations
from surfexp.nulls.variogram import variogram_pairs
from surfexp.operators.fem import fem
from surfexp_studies.nulls.null_methods import METHODS, OneSurface, null_models
from surfexp_studies.nulls.null_rejections import ROWS, Design, _planted, null_rejections, rejections_by_length

BALL = icosphere(3)
PART = cut_to_mask(replace(BALL, shape=None), BALL.mesh.vertices[:, 2] < 0.8)
OPERATOR = fem(PART.mesh)
PAIRS = variogram_pairs(PART.mesh, reach=1.0, lags=10)
OF = OneSurface(PART, BALL, OPERATOR, sx.eigenpairs(PART, 25), PAIRS, 300)
FIELDS = gaussian_fields(OPERATOR, 0.7, 24, 3)
DESIGN = Design(maps=6, nulls=39, planted=(0.1, 0.9), planted_partners=8, examined=2)
FOUND = null_rejections(OF, FIELDS, DESIGN)


def test_all_methods_give_nulls_of_the_map() -> None:
    models = null_models(OF)
    assert tuple(models) == METHODS
    for name, model in models.items():
        nulls = model(FIELDS[:, 0], 5, 1)
        assert nulls.shape == (len(FIELDS), 5)
        assert np.isnan(nulls).any() == (name == "spins")
        np.testing.assert_array_equal(nulls, model(FIELDS[:, 0], 5, 1))
        assert not np.allclose(nulls, model(FIELDS[:, 0], 5, 2), equal_nan=True)
    rough = gaussian_fields(OPERATOR, 0.25, 1, 1)[:, 0]
    fine, published = (models[name](rough, 5, 1) for name in ("variogram_fine", "variogram"))
    assert not np.allclose(fine, published)
    dropped, permuted = (models[name](FIELDS[:, 0], 5, 1) for name in ("eigenstrapping", "eigenstrapping_rest"))
    assert not np.allclose(dropped, permuted)


def test_the_table_has_a_row_for_each_method_and_its_metrics() -> None:
    assert FOUND.rows == ROWS and FOUND.metrics["pairs"] == 6 * 18
    value, low, high = FOUND.columns["rejections"].T
    assert (low <= value).all() and (value <= high).all() and high.max() <= 100.0
    for row, name in enumerate(ROWS):
        assert FOUND.metrics[f"rejections {name}"] == value[row]
        assert FOUND.metrics[f"highest {name}"] == high[row] and FOUND.metrics[f"lowest {name}"] == low[row]
        assert FOUND.metrics[f"exact_enough {name}"] == (low[row] <= 6.0 and high[row] >= 4.0)
        assert FOUND.metrics[f"power 0.1 {name}"] == FOUND.columns["power 0.1"][row]


def test_identities_hold_and_naive_tests_reject_most() -> None:
    assert FOUND.metrics["power_error eigenstrapping"] < 1e-12 < FOUND.metrics["power_error eigenstrapping_rest"]
    assert FOUND.metrics["values_error permutation"] == 0.0 < FOUND.metrics["values_error spins"]
    assert FOUND.metrics["variogram_error permutation"] > 2.0 * FOUND.metrics["variogram_error variogram_fine"]
    assert FOUND.columns["unknown"][METHODS.index("spins")] == pytest.approx(10.0, abs=4.0)
    assert FOUND.columns["unknown"][0] == 0.0 and np.isnan(FOUND.columns["unknown"][-1])
    for name in ("permutation", "parametric"):
        assert FOUND.metrics[f"rejections {name}"] > 40.0 > FOUND.metrics["rejections eigenstrapping"]
    assert FOUND.metrics["power 0.9 eigenstrapping"] > 70.0 > FOUND.metrics["power 0.1 eigenstrapping"]


def test_planted_partners_have_the_correlation_in_the_mean() -> None:
    many = gaussian_fields(OPERATOR, 0.2, 400, 1)
    planted = _planted(many[:, 0], many[:, 1:], Design(planted=(0.2, 0.8), planted_partners=390))
    found = correlations(many[:, :1], planted)[0].reshape(2, 390).mean(axis=1)
    np.testing.assert_allclose(found, [0.2, 0.8], atol=0.02)
    np.testing.assert_allclose(planted.std(), 1.0, atol=0.02)


def test_lengths_are_put_in_order() -> None:
    other = null_rejections(OF, FIELDS[:, ::-1], DESIGN)
    table = rejections_by_length({Member("b"): FOUND, Member("a"): other}, [9.0, 4.0])
    np.testing.assert_array_equal(table.columns["length"], [4.0, 9.0])
    np.testing.assert_array_equal(table.columns["spins"][1], FOUND.columns["rejections"][ROWS.index("spins")])
    np.testing.assert_array_equal(table.columns["spins"][0], other.columns["rejections"][ROWS.index("spins")])
    np.testing.assert_array_equal(table.columns["level"], 5.0)
    for name in ROWS:
        wanted = FOUND.metrics[f"exact_enough {name}"] + other.metrics[f"exact_enough {name}"]
        assert table.metrics[f"exact_lengths {name}"] == wanted


def test_bad_designs_are_refused() -> None:
    for design in (Design(maps=1), Design(maps=23), Design(maps=6, planted_partners=19), Design(maps=6, examined=7)):
        with pytest.raises(ValueError, match="24 fields are"):
            null_rejections(OF, FIELDS, design)
    with pytest.raises(ValueError, match="sphere has 162 vertices, the surface was cut from 642"):
        null_models(OneSurface(PART, icosphere(2), OPERATOR, OF.eigensystem, PAIRS, 300))
