"""Heat flow, geodesic curvature flow, and denoising of geometry by its normals."""

import numpy as np
import pytest

from surfexp.mesh.noise import add_vertex_noise
from surfexp.mesh.shapes.cube import cube
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import fem
from surfexp.variational.image import Image
from surfexp.variational.level_sets import perimeters
from surfexp.variational.models.rof import ROF
from surfexp.variational.normal_filtering import NormalFiltering, normal_deviation, update_vertices
from surfexp.variational.solvers.primal_dual import primal_dual
from surfexp.variational.surface_flows import geodesic_curvature_flow, heat_flow

SPHERE = icosphere(4).mesh


def test_heat_flow_decays_harmonics_at_first_order_in_time() -> None:
    operator, height = fem(SPHERE), SPHERE.vertices[:, 2]
    errors = []
    for steps in (10, 20, 40):
        warm = heat_flow(operator, height, 0.5, steps)
        assert abs(operator.mass @ warm) <= 1e-12 + abs(operator.mass @ height) * 1.001
        errors.append(abs((operator.mass * warm) @ height / ((operator.mass * height) @ height) - np.exp(-1.0)))
    assert errors[2] < 0.01 and errors[0] / errors[2] > 3.0


def test_cap_shrinks_by_its_geodesic_curvature() -> None:
    """cos alpha(t) = e^t cos alpha(0) for a circle of polar angle alpha on the unit sphere."""
    start, time = 1.1, 0.4
    exact = np.sqrt(1 - (np.exp(time) * np.cos(start)) ** 2)
    errors = []
    for levels, steps in ((3, 20), (4, 80)):
        mesh = icosphere(levels).mesh
        operator = fem(mesh)
        distance = start - np.arccos(np.clip(mesh.vertices[:, 2], -1, 1))
        moved = geodesic_curvature_flow(operator, distance, time, steps)
        errors.append(abs(perimeters(operator, moved, np.zeros(1))[0] / (2 * np.pi) - exact))
    assert errors[1] < 0.004 and errors[1] < 0.5 * errors[0]


def test_a_curvature_flow_follows_the_units_of_map_and_surface() -> None:
    mesh = icosphere(2).mesh
    distance = 1.1 - np.arccos(np.clip(mesh.vertices[:, 2], -1, 1))
    moved = geodesic_curvature_flow(fem(mesh), distance, 0.2, 5)
    larger = fem(TriangleMesh(10.0 * mesh.vertices, mesh.faces))
    np.testing.assert_allclose(geodesic_curvature_flow(larger, 300.0 * distance, 20.0, 5), 300.0 * moved, atol=1e-9)


def test_equator_stays() -> None:
    operator = fem(SPHERE)
    moved = geodesic_curvature_flow(operator, np.arcsin(SPHERE.vertices[:, 2]), 0.2, 20)
    assert np.abs(moved[np.abs(SPHERE.vertices[:, 2]) < 1e-12]).max() <= 1e-6


def test_normals_beat_coordinates_and_do_not_depend_on_the_axes() -> None:
    deviations, by_channel = [], []
    for rotation in ((0.0, 0.0, 0.0), (20.0, 30.0, 40.0)):
        clean = cube(12, rotation=rotation).mesh
        noisy = add_vertex_noise(cube(12), 0.03, seed=1).mesh
        turn = np.linalg.lstsq(cube(12).mesh.vertices, clean.vertices, rcond=None)[0]
        noisy = TriangleMesh(noisy.vertices @ turn, noisy.faces)
        solution = NormalFiltering().run(noisy)
        assert solution.converged and solution.relative_gap <= 1e-4
        deviations.append(normal_deviation(TriangleMesh(solution.values, clean.faces), clean))
        image = Image(noisy.vertices, noise=0.03)
        moved = ROF(by_channel=True).run(image, fem(noisy), primal_dual).values
        by_channel.append(normal_deviation(TriangleMesh(moved, clean.faces), clean))
        assert normal_deviation(noisy, clean) > 15
    assert deviations[0] == pytest.approx(deviations[1], abs=0.01) and deviations[0] < 7
    assert by_channel[1] > 2 * by_channel[0] and deviations[1] < by_channel[1]


def test_vertex_update_leaves_a_mesh_with_its_own_normals_alone() -> None:
    mesh = cube(6).mesh
    assert np.abs(update_vertices(mesh, mesh.face_normals, 10) - mesh.vertices).max() <= 1e-14
    assert normal_deviation(mesh, mesh) <= 1e-5
    with pytest.raises(ValueError, match="weight is 0"):
        NormalFiltering(weight=0).run(mesh)
