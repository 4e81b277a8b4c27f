"""Tri-linear and tri-cubic interpolation: exact on polynomials, right orders, right range."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.baselines.grid_interpolation import grid_interpolation
from surfexp.baselines.narrow_band import interpolation_radius, narrow_band
from surfexp.mesh.shapes.icosphere import icosphere

MESH = icosphere(2).mesh


@pytest.mark.parametrize("degree", [1, 3])
def test_polynomials_are_reproduced(degree):
    band = narrow_band(MESH, 0.1, interpolation_radius(degree))
    sample = grid_interpolation(band, band.closest, degree)

    def polynomial(p):
        return (1 + p[:, 0] ** degree) * (2 - p[:, 1] ** degree) * (0.5 + p[:, 2] ** degree - p[:, 2])

    np.testing.assert_allclose(sample(polynomial(band.positions)), polynomial(band.closest), atol=1e-12)


@pytest.mark.parametrize("degree", [1, 3])
def test_order_of_interpolation(degree):
    errors = []
    for step in (0.16, 0.08, 0.04):
        band = narrow_band(MESH, step, interpolation_radius(degree))
        values = np.sin(band.positions @ [1.0, 2.0, 3.0])
        sample = grid_interpolation(band, MESH.vertices, degree)(values)
        errors.append(np.abs(sample - np.sin(MESH.vertices @ [1.0, 2.0, 3.0])).max())
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (rates > degree + 0.6).all(), (errors, rates)


def test_linear_interpolation_keeps_the_range():
    band = narrow_band(MESH, 0.1, interpolation_radius(1))
    values = np.random.default_rng(0).uniform(0, 1, band.node_count)
    sample = grid_interpolation(band, MESH.vertices, 1)(values)
    assert sample.min() >= 0 and sample.max() <= 1 + 1e-15


def test_what_cannot_be_interpolated_is_refused():
    band = narrow_band(MESH, 0.1, interpolation_radius(1))
    with pytest.raises(ValueError, match="choose 1 or 3"):
        grid_interpolation(band, MESH.vertices, 2)
    with pytest.raises(ValueError, match=r"take interpolation_radius\(3\)"):
        grid_interpolation(band, MESH.vertices, 3)
