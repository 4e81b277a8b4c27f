"""Drawn level sets: on the right pixels, of one width, unbroken, and only where the surface is seen."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.ndimage import label

from surfexp.figures.camera import Camera, fit_camera
from surfexp.figures.contours import Contours, line_coverage
from surfexp.figures.rasterizer import rasterize
from surfexp.mesh.shapes.disk import disk
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.triangle_mesh import TriangleMesh


def drawn_line(mesh: TriangleMesh, contours: Contours, camera: Camera) -> np.ndarray:
    return line_coverage(mesh, contours.lines(mesh), contours.width, camera, rasterize(mesh, camera))


@pytest.mark.parametrize("angle", [0.0, 0.4, 1.3])
@pytest.mark.parametrize("width", [1.0, 2.5])
def test_line_on_a_plane_is_at_its_distance_to_every_pixel(angle: float, width: float) -> None:
    mesh, normal = disk(12).mesh, np.array([np.cos(angle), np.sin(angle), 0.0])
    camera = fit_camera(mesh, "top", (120, 120))
    coverage = drawn_line(mesh, Contours(mesh.vertices @ normal, (0.2,), width=width), camera)
    row, column = np.nonzero(rasterize(mesh, camera).covered)
    # the disk fills the frame but for the margin of 3 %
    x, y = (column + 0.5 - 60.0) / camera.scale, (60.0 - row - 0.5) / camera.scale
    away = camera.scale * np.abs(x * normal[0] + y * normal[1] - 0.2)
    inside = np.hypot(x, y) < 0.9
    expected = np.clip(0.5 * width + 0.5 - away, 0.0, 1.0)
    assert np.allclose(coverage[row, column][inside], expected[inside], atol=1e-9)


def test_border_of_a_labelling_is_not_broken_at_face_edges() -> None:
    sphere = icosphere(3).mesh
    camera = fit_camera(sphere, "front", (200, 200))
    labels = (np.linalg.norm(sphere.vertices - [0.0, 1.0, 0.0], axis=1) < 0.8).astype(float)
    line = drawn_line(sphere, Contours(labels, (0.5,)), camera) > 0.5
    eight = np.ones((3, 3))
    assert label(line, eight)[1] == 1
    # one ring: outside and inside
    assert label(~line)[1] == 2


def test_width_on_the_screen_does_not_depend_on_the_slope() -> None:
    # a roof: the same lines on a face seen from above and on a steep one
    points = np.array([[x, y, z] for x, z in ((0.0, 0.0), (20.0, 0.0), (40.0, 30.0)) for y in (0.0, 20.0)])
    mesh = TriangleMesh(points, np.array([[0, 2, 1], [1, 2, 3], [2, 4, 3], [3, 4, 5]]))
    camera = Camera(np.eye(3), np.zeros(3), (40, 20), 1.0, (0.0, 20.0))
    coverage = drawn_line(mesh, Contours(points[:, 1], (10.0,), width=3.0), camera)
    assert np.allclose(coverage.sum(axis=0), 3.0, atol=1e-9)


def test_hidden_lines_are_not_drawn() -> None:
    sphere = icosphere(4).mesh
    camera = fit_camera(sphere, "front", (150, 150))
    y = sphere.vertices[:, 1]
    assert drawn_line(sphere, Contours(y, (-0.3, -0.8)), camera).max() == 0.0
    assert drawn_line(sphere, Contours(y, (0.3, 0.8)), camera).max() == 1.0


def test_line_does_not_spill_over_what_is_far_behind_it() -> None:
    near = np.array([[0.0, 0, 9], [20, 0, 9], [0, 20, 9], [20, 20, 9]])
    far = near * [2, 1, 0] + [0.0, 0.0, -50.0]
    mesh = TriangleMesh(np.vstack([near, far]), np.array([[0, 1, 2], [2, 1, 3], [4, 5, 6], [6, 5, 7]]))
    camera = Camera(np.eye(3), np.zeros(3), (40, 20), 1.0, (0.0, 20.0))
    # along the border x = 20 of the near square, nearly
    field = np.append(near[:, 0] - 19.9, np.full(4, -9.0))
    coverage = drawn_line(mesh, Contours(field, width=4.0), camera)
    assert coverage[10, 18:20].min() > 0.9
    assert coverage[:, 20:].max() == 0.0


def test_field_that_is_constant_or_nan_draws_nothing() -> None:
    sphere = icosphere(1).mesh
    camera = fit_camera(sphere, size=(50, 50))
    for field in (np.zeros(42), np.full(42, np.nan)):
        assert drawn_line(sphere, Contours(field, (0.0, 1.0)), camera).max() == 0.0
