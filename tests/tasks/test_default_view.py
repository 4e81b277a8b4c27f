"""The first look at a body that is no hemisphere: it stands, and most of it faces the eye."""

from __future__ import annotations

import numpy as np
import pytest

import surfexp as sx
from surfexp.figures.lines import Lines
from surfexp.figures.render import SurfaceView
from surfexp.mesh.spatial_frame import SpatialFrame
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.tasks.default_view import HIGH, LOW, Y_UP, Z_UP, fullest_view, projected_areas, standing, upright

CORNERS = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
# corners of each side, and two triangles of each
SIDES = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
FACES = SIDES[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)


def boxes(*given: tuple[tuple[float, float, float], tuple[float, float, float]]) -> TriangleMesh:
    """Boxes by corner and size."""
    points = np.concatenate([CORNERS * size + corner for corner, size in given])
    faces = np.concatenate([FACES + 8 * k for k in range(len(given))])
    return TriangleMesh(points, faces)


def about_z(mesh: TriangleMesh, degrees: float) -> TriangleMesh:
    a = np.radians(degrees)
    turn = np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1.0]])
    return TriangleMesh(mesh.vertices @ turn.T, mesh.faces)


# a body along x on four legs along z, with a neck upward and forward
ANIMAL = boxes(
    ((0.0, -0.1, 2.0), (4.0, 1.2, 1.0)),
    *(((x, y, 0.0), (0.2, 0.2, 2.0)) for x in (0.0, 3.8) for y in (0.0, 0.8)),
    ((4.0, 0.4, 2.6), (0.8, 0.2, 1.6)),
)
# rows: y up to z up is Y_UP, so its transpose lays a body down
LYING = TriangleMesh(ANIMAL.vertices @ Y_UP, ANIMAL.faces)


def test_an_animal_with_y_up_stands_and_is_seen_from_above_as_that_with_z_up() -> None:
    assert upright(Surface(ANIMAL)) is Z_UP and upright(Surface(LYING)) is Y_UP
    for mesh in (ANIMAL, LYING):
        ((shown,),) = sx.plot(Surface(mesh), width=200).views
        np.testing.assert_allclose(shown.mesh.vertices, ANIMAL.vertices, atol=1e-12)
        assert isinstance(shown.view, tuple) and shown.view[1] == LOW > 0
        scene = sx.view(Surface(mesh)).scene
        assert scene.view == shown.view == fullest_view(ANIMAL)
        np.testing.assert_allclose(scene.surfaces[0].mesh.vertices, ANIMAL.vertices, atol=1e-12)


def test_a_side_is_seen_and_not_the_front() -> None:
    azimuth, _ = fullest_view(ANIMAL)
    assert abs(np.sin(np.radians(azimuth))) > 0.8


def test_lines_in_space_turn_with_their_body() -> None:
    flat = TriangleMesh(LYING.vertices, LYING.faces)
    sides = (flat.vertices[:, 0] > 2.0).astype(int)
    ((shown,),) = sx.plot(Surface(flat), sides, width=200).views
    ((plain,),) = sx.plot(Surface(flat), sides, views="oblique", width=200).views
    (turned,), (still) = shown.contours, plain.contours[0]
    assert isinstance(turned, Lines) and isinstance(still, Lines)
    np.testing.assert_allclose(turned.points, still.points @ Y_UP.T, atol=1e-12)
    assert np.array_equal(plain.mesh.vertices, flat.vertices) and plain.view == (-60.0, 25.0)


def test_a_file_that_names_its_space_is_not_turned() -> None:
    brain = Surface(LYING, frame=SpatialFrame(metadata={"AnatomicalStructurePrimary": "Hippocampus"}))
    assert upright(brain) is Z_UP
    assert upright(Surface(LYING, frame=SpatialFrame())) is Y_UP


def test_what_would_fall_does_not_stand() -> None:
    spike = ((5.9, 1.0, 2.1), (0.1, 1.0, 0.1))
    for foot, stands in ((1.0, False), (5.0, True)):
        tower = boxes(((0.0, 0.1, 0.0), (foot, 0.8, 2.0)), ((0.0, 0.0, 2.0), (6.0, 1.0, 1.0)), spike)
        laid = TriangleMesh(tower.vertices @ Y_UP, tower.faces)
        assert (upright(Surface(laid)) is Y_UP) == stands


@pytest.mark.parametrize("mesh", [boxes(((0, 0, 0), (1, 1, 1))), sx.shape("icosphere", levels=3).mesh])
def test_what_stands_as_well_on_both_stays(mesh: TriangleMesh) -> None:
    assert upright(Surface(mesh)) is Z_UP


@pytest.mark.parametrize("degrees", np.arange(0.0, 360.0, 15.0).tolist())
def test_a_body_turned_about_z_is_seen_from_as_much(degrees: float) -> None:
    turned = about_z(ANIMAL, degrees)
    seen, seen_before = (projected_areas(mesh, fullest_view(mesh))[0] for mesh in (turned, ANIMAL))
    assert seen == pytest.approx(seen_before, rel=0.02)


def test_the_area_of_a_box_is_that_of_its_shadow() -> None:
    box = boxes(((0, 0, 0), (4, 1, 2)))
    a, e = np.radians([30.0, 25.0])
    shadow = 2.0 * np.cos(e) * np.cos(a) + 8.0 * np.cos(e) * np.sin(a) + 4.0 * np.sin(e)
    assert projected_areas(box, (30.0, 25.0)) == pytest.approx((shadow, shadow))
    # most is seen at tan(azimuth) = 8 / 2, of multiples of 15 degrees at 75; the nearest such to -60 is -75
    assert fullest_view(box) == (-75.0, LOW)


def test_a_flat_thing_is_seen_from_above_and_an_open_one_from_outside() -> None:
    x, y = (axis.ravel() for axis in np.meshgrid(np.linspace(0, 1, 5), np.linspace(0, 1, 5)))
    k = np.arange(20)[np.arange(20) % 5 < 4]
    faces = np.concatenate([np.stack([k, k + 1, k + 6], axis=1), np.stack([k, k + 6, k + 5], axis=1)])
    assert fullest_view(TriangleMesh(np.stack([x, y, 0 * x], axis=1), faces))[1] == HIGH
    ball = sx.shape("icosphere", levels=3).mesh
    for side in (1.0, -1.0):
        half = TriangleMesh(ball.vertices, ball.faces[(side * ball.vertices[ball.faces, 0] > -0.2).all(axis=1)])
        azimuth, _ = fullest_view(half)
        assert side * np.cos(np.radians(azimuth)) > 0.5


@pytest.mark.parametrize("count, rows", [(4, [4]), (6, [6]), (7, [4, 3]), (10, [5, 5]), (13, [5, 5, 3])])
def test_many_bodies_stand_in_rows_of_six_at_most(count: int, rows: list[int]) -> None:
    views = sx.plot([Surface(ANIMAL)] * count, width=400).views
    assert [len(row) for row in views] == rows


def test_vertices_without_a_face_or_position_do_not_count() -> None:
    points = np.concatenate([LYING.vertices, [[0.0, -50.0, 0.0], [np.nan, 0.0, 0.0]]])
    assert upright(Surface(TriangleMesh(points, LYING.faces))) is Y_UP
    assert upright(Surface(TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), int)))) is Z_UP


@pytest.mark.parametrize("nowhere", [np.nan, np.inf])
@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_a_vertex_that_is_nowhere_does_not_turn_a_body(nowhere: float) -> None:
    far = np.vstack([LYING.vertices, [[nowhere, 0.0, 1.0]]])
    holed = TriangleMesh(far, np.vstack([LYING.faces, [[0, 1, len(far) - 1]]]))
    assert upright(Surface(holed)) is Y_UP
    shown = standing([[SurfaceView(holed)]], Surface(holed))[0][0]
    whole = standing([[SurfaceView(LYING)]], Surface(LYING))[0][0]
    assert shown.view == whole.view
    np.testing.assert_array_equal(shown.mesh.vertices[:-1], whole.mesh.vertices)
