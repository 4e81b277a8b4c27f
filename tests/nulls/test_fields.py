"""Fields have variance 1 and the correlation length that was asked for, all over or varying."""

import numpy as np
import pytest
from numpy.polynomial.legendre import legval
from scipy.linalg import expm

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.torus import torus
from surfexp.nulls.fields import _metric_of, _variance, gaussian_fields
from surfexp.operators.assembly import stiffness
from surfexp.operators.fem import fem

BALL = fem(icosphere(3).mesh)
PLACES = icosphere(3).mesh.vertices
WIDTHS = 0.6 * 3.0 ** (0.5 * PLACES[:, 2])


@pytest.mark.parametrize("width", [0.3, WIDTHS], ids=["stationary", "varying"])
def test_the_variance_is_that_of_dense_algebra(width: float | np.ndarray) -> None:
    """diag(exp(-2 t L) M^-1) for L = M^-1 S, in the metric in which the width is constant."""
    largest = float(np.max(width))
    mass = (largest / np.asarray(width)) ** 2 * BALL.mass
    time = 0.25 * (largest / np.sqrt(8 * np.log(2))) ** 2
    root = np.sqrt(mass)
    wanted = (expm(-2.0 * time * stiffness(BALL).toarray() / np.outer(root, root)) / np.outer(root, root)).diagonal()
    np.testing.assert_allclose(_variance(*_metric_of(BALL, width)), wanted, rtol=1e-4)


def test_fields_are_independent_of_variance_1_at_each_vertex() -> None:
    fields = gaussian_fields(BALL, 0.5, 4000, 1)
    np.testing.assert_allclose(fields.std(axis=1), 1.0, atol=0.06)
    assert np.abs(fields.mean(axis=1)).max() < 0.08
    # 40 or so independent patches
    assert np.abs((fields[:, ::2] * fields[:, 1::2]).mean()) < 0.01
    np.testing.assert_array_equal(gaussian_fields(BALL, 0.5, 2, 3), gaussian_fields(BALL, 0.5, 2, 3))
    assert not np.allclose(gaussian_fields(BALL, 0.5, 2, 3), gaussian_fields(BALL, 0.5, 2, 4))


def test_the_correlation_is_that_of_the_sphere_and_has_the_width_that_was_asked_for() -> None:
    """By the series of Legendre polynomials, whose half width is that of the plane but for the curvature."""
    time, degrees = 0.25 * (0.6 / np.sqrt(8 * np.log(2))) ** 2, np.arange(60)
    powers = (2 * degrees + 1) * np.exp(-2.0 * time * degrees * (degrees + 1))
    assert legval(np.cos(0.3), powers) / legval(1.0, powers) == pytest.approx(0.5, abs=0.005)
    fields = gaussian_fields(BALL, 0.6, 6000, 2)
    for vertex in (0, 300):
        wanted = legval(PLACES @ PLACES[vertex], powers) / legval(1.0, powers)
        found = fields @ fields[vertex] / fields.shape[1]
        assert np.sqrt(((found - wanted) ** 2).mean()) < 0.02 and np.abs(found - wanted).max() < 0.08


def _local_width(fields: np.ndarray, vertex: int) -> float:
    """From the correlations exp(-4 log 2 d^2 / width^2) above .4 around a vertex."""
    arcs = np.arccos(np.clip(PLACES @ PLACES[vertex], -1.0, 1.0))
    correlation = fields @ fields[vertex] / (fields.std(axis=1) * fields[vertex].std() * fields.shape[1])
    near = (correlation > 0.4) & (arcs > 1e-6)
    return float(np.median(arcs[near] * np.sqrt(4.0 * np.log(2.0) / -np.log(correlation[near]))))


def test_a_varying_width_varies() -> None:
    """To 12 % where it is four edges or more, and elsewhere as a stationary field of that width."""
    fields = gaussian_fields(BALL, WIDTHS, 6000, 2)
    south, north = int(PLACES[:, 2].argmin()), int(PLACES[:, 2].argmax())
    for vertex in (0, north):
        assert _local_width(fields, vertex) == pytest.approx(WIDTHS[vertex], rel=0.12)
    stationary = gaussian_fields(BALL, float(WIDTHS[south]), 6000, 3)
    assert _local_width(fields, south) == pytest.approx(_local_width(stationary, south), rel=0.05)
    assert WIDTHS.max() / WIDTHS.min() == pytest.approx(3.0)
    # one width everywhere, as an array or as a number
    ring = fem(torus(24, 10).mesh)
    same = gaussian_fields(ring, np.full(ring.vertex_count, 0.5), 2, 1)
    np.testing.assert_allclose(same, gaussian_fields(ring, 0.5, 2, 1), atol=1e-10)


def test_bad_input_is_refused() -> None:
    with pytest.raises(ValueError, match="count is 0, at least 1"):
        gaussian_fields(BALL, 0.5, 0)
    with pytest.raises(ValueError, match=r"width has shape \(\) and least value 0"):
        gaussian_fields(BALL, 0.0, 1)
    with pytest.raises(ValueError, match=r"width has shape \(5,\) and least value 1: one, or 642"):
        gaussian_fields(BALL, np.ones(5), 1)
    with pytest.raises(ValueError, match="all positive"):
        gaussian_fields(BALL, np.full(642, np.inf), 1)
