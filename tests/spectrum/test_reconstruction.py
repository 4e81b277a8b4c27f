"""Accuracy curves against least squares, Parseval, and bases that are known to be enough."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from surfexp.mesh.shapes.ellipsoid import ellipsoid
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.assembly import mass_matrix
from surfexp.operators.fem import fem
from surfexp.spectrum.reconstruction import accuracy_curves, area_over_log, orthonormal_in
from surfexp.spectrum.surface_spectrum import surface_spectrum

BALL, BODY = icosphere(2), ellipsoid(2, (1.0, 1.3, 2.0))
MASS = mass_matrix(fem(BODY.mesh))
OWN, FOREIGN = surface_spectrum(BODY, fem(BODY.mesh), 30).vectors, surface_spectrum(BALL, fem(BALL.mesh), 30).vectors
WEIGHTS = np.asarray(MASS.sum(axis=1)).ravel()


def correlation(first: np.ndarray, second: np.ndarray) -> float:
    """By area, with the integrals of products of piecewise linear functions."""
    one, other = (values - WEIGHTS @ values / WEIGHTS.sum() for values in (first, second))
    return float(one @ (MASS @ other) / np.sqrt((one @ (MASS @ one)) * (other @ (MASS @ other))))


@pytest.mark.parametrize("basis", [OWN, FOREIGN], ids=["own", "foreign"])
def test_a_curve_is_the_correlation_with_the_least_squares_fit_of_every_size(basis: np.ndarray) -> None:
    maps = np.random.default_rng(3).normal(size=(len(basis), 2)) + BODY.mesh.vertices[:, :2] * 20.0 + 5.0
    curves = accuracy_curves(basis, MASS, maps)
    assert (curves[0] == 0.0).all() and (np.diff(curves, axis=0) >= 0.0).all() and curves.max() < 1.0
    root = np.linalg.cholesky(MASS.toarray()).T
    for k in (2, 3, 7, 30):
        for j in (0, 1):
            fit = basis[:, :k] @ np.linalg.lstsq(root @ basis[:, :k], root @ maps[:, j], rcond=None)[0]
            assert curves[k - 1, j] == pytest.approx(correlation(maps[:, j], fit), abs=1e-10)


def test_what_modes_span_they_explain_from_their_number_on() -> None:
    coefficients = np.array([2.0, 3.0, 0.0, 4.0, 0.0, 12.0])
    curve = accuracy_curves(OWN, MASS, OWN[:, :6] @ coefficients[:, None])[:, 0]
    # Parseval: of 3^2 + 4^2 + 12^2 = 169, without the constant part
    np.testing.assert_allclose(curve[:6], np.sqrt([0, 9, 9, 25, 25, 169]) / 13.0, atol=1e-9)
    np.testing.assert_allclose(curve[5:], 1.0, atol=1e-12)
    height = icosphere(3).mesh.vertices[:, [2]]
    harmonics = surface_spectrum(icosphere(3), fem(icosphere(3).mesh), 9).vectors
    assert accuracy_curves(harmonics, mass_matrix(fem(icosphere(3).mesh)), height)[3:, 0].min() > 0.99999


def test_only_the_order_of_spans_counts() -> None:
    """Neither lengths nor signs of functions, nor what is added of those before them."""
    rng = np.random.default_rng(0)
    mixed = FOREIGN @ (np.triu(rng.normal(size=(30, 30)), 1) * 0.3 + np.diag(rng.uniform(-9.0, -1.0, 30)))
    mixed[:, 0] = 7.0
    maps = rng.normal(size=(len(mixed), 3))
    np.testing.assert_allclose(accuracy_curves(mixed, MASS, maps), accuracy_curves(FOREIGN, MASS, maps), atol=1e-8)
    found = orthonormal_in(mixed, MASS)
    np.testing.assert_allclose(found.T @ (MASS @ found), np.eye(30), atol=1e-12)


def test_the_area_over_log_is_exact_where_curves_are_linear_in_log() -> None:
    k = np.arange(1.0, 41.0)
    curves = np.column_stack([np.full(40, 0.7), np.log(k), k])
    flat, logarithm, linear = area_over_log(curves, 4, 40)
    assert flat == pytest.approx(0.7) and logarithm == pytest.approx(0.5 * np.log(160.0))
    assert linear == pytest.approx(36.0 / np.log(10.0), rel=5e-3)


def test_what_has_no_meaning_is_refused() -> None:
    ones = np.ones((162, 1))
    maps = np.random.default_rng(0).normal(size=(162, 2))
    with pytest.raises(ValueError, match="the first function of the basis varies by"):
        accuracy_curves(OWN[:, 1:], MASS, maps)
    with pytest.raises(ValueError, match="map 1 is constant"):
        accuracy_curves(OWN, MASS, np.column_stack([maps[:, 0], 3.0 * ones]))
    with pytest.raises(ValueError, match="condition"):
        orthonormal_in(np.column_stack([OWN, OWN[:, 3]]), MASS)
    with pytest.raises(ValueError, match=r"basis has shape \(162, 30\), take 1 to 3 columns"):
        orthonormal_in(OWN, csr_array(np.eye(3)))
    with pytest.raises(ValueError, match=r"maps have shape \(161, 2\)"):
        accuracy_curves(OWN, MASS, maps[1:])
    for first, last in ((0, 10), (10, 10), (10, 31)):
        with pytest.raises(ValueError, match="take 1 <= first < last <= 30"):
            area_over_log(OWN[:30], first, last)
