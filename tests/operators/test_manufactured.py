"""Errors on manufactured functions fall at the orders that the theory gives; the exact fields check one another."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.mesh.shapes.cube import cube
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.torus import torus
from surfexp.operators.fem import fem
from surfexp.operators.manufactured import manufactured, operator_errors
from surfexp.operators.vertex_averaged import vertex_averaged


def orders(operator, surfaces):
    errors = [operator_errors(operator(surface.mesh), manufactured(surface)) for surface in surfaces]
    return {name: np.log2(errors[0][name] / errors[1][name]) for name in errors[0]}


def test_orders_on_the_structured_torus() -> None:
    surfaces = [torus(80, 32), torus(160, 64)]
    faces, averaged = orders(fem, surfaces), orders(vertex_averaged, surfaces)
    assert faces["gradient_error"] == pytest.approx(1.0, abs=0.1)
    assert faces["divergence_error"] == pytest.approx(2.0, abs=0.2)
    assert averaged["gradient_error"] == pytest.approx(2.0, abs=0.2)
    for name in ("laplacian_error", "laplacian_error_max", "laplacian_error_weak"):
        assert faces[name] == pytest.approx(2.0, abs=0.25)


def test_the_laplacian_converges_weakly_but_not_pointwise_on_the_icosphere() -> None:
    faces = orders(fem, [icosphere(4), icosphere(5)])
    assert faces["laplacian_error_weak"] > 1.7
    assert abs(faces["laplacian_error_max"]) < 0.3


@pytest.mark.parametrize("surface", [icosphere(4, 2.0), torus(160, 64)])
def test_gradient_and_laplacian_satisfy_greens_formula(surface) -> None:
    exact, mass = manufactured(surface), fem(surface.mesh).mass
    dirichlet = mass @ (exact.gradient**2).sum(axis=1)
    assert dirichlet == pytest.approx(-mass @ (exact.values * exact.laplacian), rel=5e-3)


def test_other_surfaces_are_refused() -> None:
    with pytest.raises(ValueError, match="take icosphere or torus"):
        manufactured(cube(4))
