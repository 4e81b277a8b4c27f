"""Mean curvature: exact on spheres in the mean, of second order on a torus, positive where the surface bulges out."""

import numpy as np
import pytest

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.spherical_cap import spherical_cap
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.mean_curvature import mean_curvature


def test_sphere_has_one_over_its_radius() -> None:
    mesh = icosphere(3, radius=2.0).mesh
    curvature = mean_curvature(mesh)
    assert mesh.vertex_areas @ curvature / mesh.area == pytest.approx(0.5, rel=5e-3)
    flipped = TriangleMesh(mesh.vertices, mesh.faces[:, ::-1])
    assert np.allclose(mean_curvature(flipped), -curvature)


def test_torus_converges_at_second_order() -> None:
    errors = []
    for count in (24, 48, 96):
        surface = torus(count, count // 2)
        angle = surface.coordinates[:, 1]
        exact = 0.5 * (1 / 0.4 + np.cos(angle) / (1 + 0.4 * np.cos(angle)))
        errors.append(np.abs(mean_curvature(surface.mesh) - exact).max())
    assert (np.log2(np.array(errors[:-1]) / errors[1:]) > 1.8).all()


def test_boundary_takes_its_neighbours() -> None:
    curvature = mean_curvature(spherical_cap(1.0, 20).mesh)
    assert np.abs(curvature[-120:] - 1.0).max() < 0.15
