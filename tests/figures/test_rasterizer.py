"""The z-buffer against exact areas, linear functions and hand-made overlaps."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surfexp.figures.camera import Camera, fit_camera
from surfexp.figures.rasterizer import rasterize
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.triangle_mesh import TriangleMesh

# looks down the z axis: x to the right, y up
DOWN = Camera(np.eye(3), np.zeros(3), (40, 30), 1.0, (0.0, 30.0))


def test_area_of_a_spheres_silhouette_converges_to_that_of_the_disk() -> None:
    sphere = icosphere(5).mesh
    errors = []
    for size in (50, 100, 200, 400):
        # averaged over directions, because one count of lattice points in a disk is erratic
        views = [(17.0 * k, 11.0 * k - 40.0) for k in range(8)]
        errors.append(
            np.mean(
                [
                    abs(rasterize(sphere, camera).covered.sum() / (np.pi * camera.scale**2) - 1.0)
                    for camera in (fit_camera(sphere, view, (size, size)) for view in views)
                ]
            )
        )
    order = np.polyfit(np.log([50, 100, 200, 400]), np.log(errors), 1)[0]
    assert order < -0.8
    assert errors[-1] < 2e-3


@pytest.mark.parametrize("field_of_view", [0.0, 40.0])
def test_linear_functions_are_exact_at_pixel_centres(field_of_view: float) -> None:
    sphere = icosphere(2).mesh
    camera = fit_camera(sphere, (20.0, 35.0), (90, 80), field_of_view)
    raster = rasterize(sphere, camera)
    points = raster.interpolate(sphere, sphere.vertices)
    row, column = np.nonzero(raster.covered)
    screen, depth, _ = camera.project(points)
    assert np.allclose(screen, np.stack([column + 0.5, row + 0.5], axis=1), atol=1e-9)
    assert np.allclose(depth, raster.depth[raster.covered], atol=1e-12)
    assert np.allclose(raster.barycentric[raster.covered].sum(axis=1), 1.0, atol=1e-14)
    # and the point is in the plane of the face that is named
    face = sphere.faces[raster.face[raster.covered]]
    normal = sphere.face_normals[raster.face[raster.covered]]
    assert np.abs(((points - sphere.vertices[face[:, 0]]) * normal).sum(axis=1)).max() < 1e-12


@pytest.mark.parametrize("order", [[0, 1], [1, 0]])
def test_nearest_face_wins(order: list[int]) -> None:
    far, near = [[0, 0, -1], [40, 0, -1], [0, 30, -1]], [[0, 0, 2], [20, 0, 2], [0, 15, 2]]
    mesh = TriangleMesh(np.array(far + near, dtype=float), np.array([[0, 1, 2], [3, 4, 5]])[order])
    raster = rasterize(mesh, DOWN)
    # pixel (row, column) sees the point (column + 1/2, 29.5 - row)
    assert raster.face[29, 0] == order.index(1) and raster.depth[29, 0] == -2.0
    assert raster.face[29, 30] == order.index(0) and raster.depth[29, 30] == 1.0
    assert raster.face[0, 39] == -1 and np.isinf(raster.depth[0, 39])


def test_crossing_faces_meet_where_they_cut() -> None:
    slope = np.array(
        [[0, 0, 0], [40, 0, 40], [40, 30, 40], [0, 30, 0], [0, 0, 15], [40, 0, 15], [40, 30, 15], [0, 30, 15]]
    )
    mesh = TriangleMesh(slope.astype(float), np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]]))
    tilted = rasterize(mesh, DOWN).face < 2
    assert (tilted == (np.arange(40) + 0.5 > 15.0)).all()


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1), st.floats(0.0, 360.0), st.integers(3, 40))
def test_no_pixel_falls_between_two_faces(seed: int, angle: float, count: int) -> None:
    random = np.random.default_rng(seed)
    turns = np.sort(random.uniform(0.0, 2.0 * np.pi, count)) + np.radians(angle)
    turns = np.append(turns, turns[0] + np.linspace(0.0, 2.0 * np.pi, 8)[:-1])
    turns = np.sort(turns % (2.0 * np.pi))
    rim = 13.0 * np.stack([np.cos(turns), np.sin(turns), 0.0 * turns], axis=1) + [20.0, 15.0, 0.0]
    # the hub on a pixel's centre: every spoke that is level or upright runs through pixel centres
    mesh = TriangleMesh(
        np.vstack([[20.5, 15.5, 0.0], rim]),
        np.array([[0, 1 + k, 1 + (k + 1) % len(rim)] for k in range(len(rim))]),
    )
    covered = rasterize(mesh, DOWN).covered
    for line in (*covered, *covered.T):
        inside = np.flatnonzero(line)
        assert len(inside) == 0 or line[inside[0] : inside[-1] + 1].all()


def test_faces_without_area_and_vertices_that_are_not_finite_are_left_out() -> None:
    vertices = np.array([[1, 1, 0], [30, 1, 0], [1, 20, 0], [np.nan, 0, 0], [np.inf, 3, 0]])
    good = [0, 1, 2]
    bad = [[0, 0, 1], [0, 1, 3], [1, 2, 4], [2, 2, 2]]
    alone = rasterize(TriangleMesh(vertices, np.array([good])), DOWN)
    among = rasterize(TriangleMesh(vertices, np.array([*bad, good])), DOWN)
    assert alone.covered.sum() > 200
    assert (among.covered == alone.covered).all() and (among.face[among.covered] == 4).all()


def test_empty_mesh_and_surface_outside_the_frame() -> None:
    empty = TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=int))
    assert not rasterize(empty, DOWN).covered.any()
    outside = TriangleMesh(np.array([[100.0, 0, 0], [140, 0, 0], [100, 20, 0]]), np.array([[0, 1, 2]]))
    assert not rasterize(outside, DOWN).covered.any()
    around = TriangleMesh(np.array([[-500.0, -500, 0], [900, -500, 0], [0, 900, 0]]), np.array([[0, 1, 2]]))
    assert rasterize(around, DOWN).covered.all()


def test_what_is_behind_the_eye_is_not_seen() -> None:
    camera = Camera(np.eye(3), np.zeros(3), (40, 30), 1.0, (20.0, 15.0), distance=5.0)
    face = np.array([[-4.0, -4.0, 0.0], [4.0, -4.0, 0.0], [0.0, 4.0, 0.0]])
    assert rasterize(TriangleMesh(face, np.array([[0, 1, 2]])), camera).covered.any()
    behind = face + np.array([0.0, 0.0, 6.0])
    assert not rasterize(TriangleMesh(behind, np.array([[0, 1, 2]])), camera).covered.any()


@pytest.mark.parametrize("field_of_view", [0.0, 35.0])
@pytest.mark.parametrize("seed", range(4))
def test_spans_of_rows_are_what_every_pixel_of_every_face_gives(seed: int, field_of_view: float) -> None:
    random = np.random.default_rng(seed)
    corners = random.normal(size=(30, 3, 3))
    corners[::3, 2] = corners[::3, 0] + random.uniform(0.2, 1.5, (10, 1)) * (corners[::3, 1] - corners[::3, 0])
    corners[::3, 2] += 10.0 ** random.uniform(-6.0, -1.0, (10, 1))  # slivers
    mesh = TriangleMesh(corners.reshape(-1, 3), np.arange(90).reshape(-1, 3))
    camera = fit_camera(mesh, (25.0, 40.0), (61, 47), field_of_view)
    raster = rasterize(mesh, camera)
    screen, behind, divisor = (part[mesh.faces] for part in camera.project(mesh.vertices))
    x, y = np.meshgrid(np.arange(61) + 0.5, np.arange(47) + 0.5)
    nearest = np.full(x.shape, np.inf)
    for s, z, d in zip(screen, behind, divisor, strict=True):
        places = np.stack([x - s[0, 0], y - s[0, 1]])
        v, w = np.linalg.solve((s[1:] - s[0]).T, places.reshape(2, -1)).reshape(2, *x.shape)
        shares = np.stack([1.0 - v - w, v, w], axis=-1) / d
        depth = (shares * z).sum(axis=-1) / shares.sum(axis=-1)
        nearest = np.where((np.minimum(np.minimum(v, w), 1.0 - v - w) >= 0.0) & (depth < nearest), depth, nearest)
    # a pixel on the very edge of a sliver may fall to either side
    seen = np.isfinite(nearest)
    assert (seen != raster.covered).sum() <= 1
    both = seen & raster.covered
    apart = np.abs(raster.depth[both] - nearest[both])
    assert np.median(apart) < 1e-13 and (apart > 1e-8).sum() <= 1
