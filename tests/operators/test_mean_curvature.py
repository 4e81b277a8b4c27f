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


def test_a_corner_without_neighbours_inside_takes_those_that_have_a_value() -> None:
    cylinder = patch_of_cylinder(2.0, 12)
    corners = np.flatnonzero(np.bincount(cylinder.edges.ravel()) == 2)
    assert len(corners) == 2
    assert np.abs(mean_curvature(cylinder) - 0.25).max() < 5e-3
    assert mean_curvature(cylinder)[corners] == pytest.approx(0.25, rel=2e-2)


def test_a_strip_one_face_wide_has_no_curvature_and_leaves_that_of_others() -> None:
    cylinder = patch_of_cylinder(2.0, 12)
    strip = np.array([[9.0, 0.0, 0.0], [10.0, 0.0, 0.0], [9.0, 1.0, 0.0], [10.0, 1.0, 0.5]])
    faces = np.array([[0, 1, 2], [1, 3, 2]]) + len(cylinder.vertices)
    both = TriangleMesh(np.concatenate([cylinder.vertices, strip]), np.concatenate([cylinder.faces, faces]))
    found = mean_curvature(both)
    assert np.isnan(found[-4:]).all()
    assert np.array_equal(found[:-4], mean_curvature(cylinder))
    # joined at a corner of the patch, it knows no more than two rings
    corner = np.flatnonzero(np.bincount(cylinder.edges.ravel()) == 2)[0]
    hung = np.where(faces == len(found) - 4, corner, faces - (faces > len(found) - 4))
    joined = TriangleMesh(np.delete(both.vertices, -4, axis=0), np.concatenate([cylinder.faces, hung]))
    assert np.array_equal(mean_curvature(joined)[:-3], found[:-4]) and np.isnan(mean_curvature(joined)[-3:]).all()


def patch_of_cylinder(radius: float, count: int) -> TriangleMesh:
    """A quarter of a cylinder, all of whose squares are cut the same way: two corners have two neighbours, on the boundary."""
    row, column = np.mgrid[: count + 1, : count + 1].reshape(2, -1)
    angle = 0.5 * np.pi * row / count
    vertices = np.stack([radius * np.cos(angle), radius * np.sin(angle), 2.0 * column / count], axis=1)
    first = (np.arange(count)[:, None] * (count + 1) + np.arange(count)).ravel()
    below, beside, across = first + 1, first + count + 1, first + count + 2
    faces = np.concatenate([np.stack([first, beside, across], axis=1), np.stack([first, across, below], axis=1)])
    return TriangleMesh(vertices, faces)
