"""Linear filters against dense exponentials, their error bounds, and what they keep."""

from functools import partial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import eigh, expm

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.rectangle import rectangle
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.assembly import stiffness
from surfexp.operators.fem import fem
from surfexp.smoothing.heat_polynomial import (
    _coefficients,
    heat_polynomial,
    heat_polynomials,
    largest_eigenvalue_bound,
)
from surfexp.smoothing.neighbour_mean import neighbour_mean
from surfexp.variational.surface_flows import heat_flow

SHAPES = {"sphere": icosphere(2), "torus": torus(24, 10), "rectangle": rectangle(13, 9)}


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("time", [1e-4, 0.01, 1.0, 30.0])
@pytest.mark.parametrize("tolerance", [1e-3, 1e-10])
def test_the_polynomial_is_the_exponential_within_its_bound(name: str, time: float, tolerance: float) -> None:
    operator = fem(SHAPES[name].mesh)
    values = np.random.default_rng(0).standard_normal((operator.vertex_count, 2))
    found, degree, bound = heat_polynomial(operator, values, time, tolerance)
    exact = expm(-time * (stiffness(operator).toarray() / operator.mass[:, None])) @ values
    mass = operator.mass[:, None]
    error, size = (np.sqrt((mass * field**2).sum()) for field in (found - exact, values))
    assert bound <= tolerance and error <= (bound + 1e-12) * size
    assert degree <= 10 + 3 * np.sqrt(time * largest_eigenvalue_bound(operator) * np.log(1 / tolerance)) + 30


@pytest.mark.parametrize("half", [0.3, 50.0, 3e3, 1e6])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-4, 1e-8])
def test_the_bound_counts_every_term_that_is_left_out(half: float, tolerance: float) -> None:
    """The moduli of all coefficients add up to exp(0) = 1, so that those left out are 1 less those kept."""
    kept, rest = _coefficients(half, tolerance)
    left = 1.0 - np.abs(kept).sum()
    assert left - 1e-12 <= rest <= tolerance


def test_nobody_who_names_no_tolerance_gets_a_coarse_one() -> None:
    operator = fem(SHAPES["torus"].mesh)
    values = np.random.default_rng(1).standard_normal(operator.vertex_count)
    assert heat_polynomial(operator, values, 0.1)[2] <= 1e-8
    assert all(bound <= 1e-8 for _, _, bound in heat_polynomials(operator, values, [0.01, 0.1]))


def test_a_constant_stays_on_slivers_whatever_the_tolerance() -> None:
    flat = SHAPES["rectangle"].mesh
    slivers = fem(TriangleMesh(flat.vertices * [1.0, 1e-2, 1.0], flat.faces))
    ones = np.ones(slivers.vertex_count)
    for tolerance in (1e-2, 1e-6):
        found, _, bound = heat_polynomial(slivers, ones, 1.0, tolerance)
        assert np.abs(found - 1.0).max() <= bound + 1e-9 and bound <= tolerance


@pytest.mark.parametrize("name", SHAPES)
def test_no_eigenvalue_exceeds_the_bound(name: str) -> None:
    operator = fem(SHAPES[name].mesh)
    largest = eigh(stiffness(operator).toarray(), np.diag(operator.mass), eigvals_only=True)[-1]
    # on the rectangle both are 576, and the dense solver is off by a rounding
    assert largest * (1.0 - 1e-14) <= largest_eigenvalue_bound(operator) <= 3.0 * largest


@pytest.mark.parametrize("name", SHAPES)
def test_the_bound_is_the_largest_quotient_of_a_triangle(name: str) -> None:
    operator = fem(SHAPES[name].mesh)
    weights = np.random.default_rng(0).uniform(0.01, 1.0, operator.vertex_count)
    for given_weights in (None, weights):
        own = np.ones(operator.vertex_count) if given_weights is None else given_weights
        quotients = [
            eigh(3.0 * hats @ hats.T, np.diag(own[corners]), eigvals_only=True)[-1]
            for hats, corners in zip(operator.hat_gradients, operator.faces, strict=True)
        ]
        assert largest_eigenvalue_bound(operator, given_weights) == pytest.approx(max(quotients), rel=1e-12)


@given(st.floats(1e-3, 10.0), st.integers(0, 2**31))
def test_constants_stay_the_integral_stays_and_times_add(time: float, seed: int) -> None:
    operator = fem(SHAPES["torus"].mesh)
    values = np.random.default_rng(seed).standard_normal(operator.vertex_count)
    flow = partial(heat_polynomial, operator, tolerance=1e-12)
    once = flow(values, time)[0]
    assert operator.mass @ once == pytest.approx(operator.mass @ values, abs=1e-8)
    constant = np.full(operator.vertex_count, 3.0)
    np.testing.assert_allclose(flow(constant, time)[0], 3.0, atol=1e-8)
    twice = flow(flow(values, 0.5 * time)[0], 0.5 * time)[0]
    np.testing.assert_allclose(twice, once, atol=1e-7)


def test_implicit_steps_tend_to_it_at_the_first_order() -> None:
    operator = fem(SHAPES["sphere"].mesh)
    values = SHAPES["sphere"].mesh.vertices[:, 2] ** 3
    exact = heat_polynomial(operator, values, 0.2)[0]
    errors = [np.abs(heat_flow(operator, values, 0.2, steps) - exact).max() for steps in (10, 20, 40)]
    np.testing.assert_allclose(np.array(errors[:-1]) / np.array(errors[1:]), 2.0, atol=0.2)


def test_too_long_times_and_wrong_numbers_are_refused() -> None:
    operator = fem(SHAPES["sphere"].mesh)
    values = np.ones(operator.vertex_count)
    with pytest.raises(ValueError, match="time is -1"):
        heat_polynomial(operator, values, -1.0)
    for tolerance in (0.0, -1.0, np.nan):
        with pytest.raises(ValueError, match="tolerance is"):
            heat_polynomial(operator, values, 1.0, tolerance)
    with pytest.raises(ValueError, match="take heat_flow"):
        heat_polynomial(operator, values, 1e12)
    with pytest.raises(ValueError, match="iterations is -1"):
        neighbour_mean(operator.faces, values, -1)


@given(st.integers(0, 20), st.integers(0, 2**31))
def test_the_mean_of_neighbours_by_hand(iterations: int, seed: int) -> None:
    mesh = SHAPES["rectangle"].mesh
    values = np.random.default_rng(seed).standard_normal((len(mesh.vertices), 2))
    near = [{i} for i in range(len(values))]
    for a, b in mesh.edges:
        near[a].add(b)
        near[b].add(a)
    expected = values
    for _ in range(iterations):
        expected = np.array([expected[sorted(ring)].mean(axis=0) for ring in near])
    found = neighbour_mean(mesh.faces, values, iterations)
    np.testing.assert_allclose(found, expected, atol=1e-12)
    assert found.max() <= values.max() + 1e-12 and found.min() >= values.min() - 1e-12
