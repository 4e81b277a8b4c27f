"""Generated surfaces of known area, volume, curvature and topology."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from surfexp.mesh.flat_domain import is_flat
from surfexp.mesh.shapes.cube import cube, rotation_matrix
from surfexp.mesh.shapes.disk import disk
from surfexp.mesh.shapes.ellipsoid import ellipsoid
from surfexp.mesh.shapes.fibonacci_sphere import fibonacci_sphere
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.rectangle import flat_torus, rectangle
from surfexp.mesh.shapes.spherical_cap import capped_sphere, spherical_cap
from surfexp.mesh.shapes.surface_of_revolution import surface_of_revolution
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.subdivision import subdivide
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.validate import validate


def volume(mesh: TriangleMesh) -> float:
    return float((mesh.vertices[mesh.faces[:, 0]] * mesh.face_cross_products).sum() / 6.0)


def angle_defects(mesh: TriangleMesh) -> np.ndarray:
    corners = mesh.vertices[mesh.faces]
    after, before = corners[:, [1, 2, 0]] - corners, corners[:, [2, 0, 1]] - corners
    cosines = (after * before).sum(axis=2) / (np.linalg.norm(after, axis=2) * np.linalg.norm(before, axis=2))
    angles = np.bincount(mesh.faces.ravel(), np.arccos(np.clip(cosines, -1, 1)).ravel(), len(mesh.vertices))
    flat = np.full(len(mesh.vertices), 2 * np.pi)
    for loop in mesh.boundary_loops:
        flat[loop] = np.pi
    return flat - angles


SHAPES = {
    "icosphere": (lambda: icosphere(3), 0, 0),
    "fibonacci": (lambda: fibonacci_sphere(500, 0.5, 1), 0, 0),
    "torus": (lambda: torus(40, 20, jitter=0.2), 1, 0),
    "disk": (lambda: disk(9), 0, 1),
    "rectangle": (lambda: rectangle(9, 7), 0, 1),
    "cube": (lambda: cube(5, rotation=(10, 20, 30)), 0, 0),
    "ellipsoid": (lambda: ellipsoid(2), 0, 0),
    "cap": (lambda: spherical_cap(2.0, 8), 0, 1),
    "capped sphere": (lambda: capped_sphere(1.2, 8), 0, 0),
    "dumbbell": (lambda: surface_of_revolution("dumbbell", 20, 12), 0, 0),
    "cigar": (lambda: surface_of_revolution("cigar", 21, 12), 0, 0),
}


@pytest.fixture(params=SHAPES, name="shape")
def shape_fixture(request: pytest.FixtureRequest) -> tuple[Surface, int, int]:
    make, genus, loops = SHAPES[request.param]
    return make(), genus, loops


def test_topology_and_validity(shape: tuple[Surface, int, int]) -> None:
    surface, genus, loops = shape
    assert surface.mesh.genus == genus
    assert len(surface.mesh.boundary_loops) == loops
    assert surface.mesh.is_closed == (loops == 0)
    assert validate(surface.mesh.vertices, surface.mesh.faces).ok
    assert loops or volume(surface.mesh) > 0
    assert (surface.metrics["genus"], surface.metrics["boundary_loops"]) == (genus, loops)
    assert surface.metrics["vertices"] == len(surface.mesh.vertices)
    assert 0 < surface.metrics["minimum_angle"] == surface.mesh.minimum_angle <= 60


def test_gauss_bonnet(shape: tuple[Surface, int, int]) -> None:
    mesh = shape[0].mesh
    assert angle_defects(mesh).sum() == pytest.approx(2 * np.pi * mesh.euler_characteristic, abs=1e-9)


def rates(errors: list[float]) -> list[float]:
    return [float(np.log2(coarse / fine)) for coarse, fine in pairwise(errors)]


FAMILIES = {
    "icosphere": (lambda k: icosphere(k + 1, 2.0), 16 * np.pi, 32 / 3 * np.pi),
    "torus": (lambda k: torus(20 * 2**k, 10 * 2**k), 4 * np.pi**2 * 0.4, 2 * np.pi**2 * 0.16),
    "capped sphere": (lambda k: capped_sphere(1.2, 6 * 2**k), 4 * np.pi, 4 / 3 * np.pi),
    "ellipsoid": (lambda k: ellipsoid(k + 2, (1.0, 1.0, 2.0)), None, 8 / 3 * np.pi),
    "revolved sphere": (
        lambda k: surface_of_revolution("sphere", 8 * 2**k, 12 * 2**k, 1.0),
        4 * np.pi,
        4 / 3 * np.pi,
    ),
}


@pytest.mark.parametrize("family", FAMILIES)
def test_area_and_volume_converge_at_second_order(family: str) -> None:
    make, area, content = FAMILIES[family]
    meshes = [make(k).mesh for k in range(4)]
    if family == "ellipsoid":
        eccentricity = np.sqrt(0.75)
        area = 2 * np.pi * (1 + 2 / eccentricity * np.arcsin(eccentricity))
    assert area is not None
    # a sphere revolved with rows + 2 stations is refined a little less than twice
    for exact, values in ((area, [mesh.area for mesh in meshes]), (content, [volume(mesh) for mesh in meshes])):
        assert min(rates([abs(exact - value) for value in values])[1:]) > 1.8, values


def test_disk_area_and_rim_converge_at_second_order() -> None:
    meshes = [disk(4 * 2**k, 1.5).mesh for k in range(4)]
    assert min(rates([np.pi * 2.25 - mesh.area for mesh in meshes])) > 1.9
    rims = [mesh.vertices[mesh.boundary_loops[0]] for mesh in meshes]
    lengths = [np.linalg.norm(rim - np.roll(rim, 1, axis=0), axis=1).sum() for rim in rims]
    assert min(rates([3 * np.pi - length for length in lengths])) > 1.9
    assert (meshes[0].face_normals[:, 2] == 1.0).all()


def test_cap_area_is_that_of_archimedes() -> None:
    areas = [spherical_cap(1.0, 6 * 2**k, 3.0).mesh.area for k in range(3)]
    assert min(rates([2 * np.pi * 9 * (1 - np.cos(1.0)) - area for area in areas])) > 1.9


def test_vertices_lie_on_their_shapes() -> None:
    assert np.linalg.norm(icosphere(4, 3.0).mesh.vertices, axis=1) == pytest.approx(3.0, abs=1e-14)
    x, y, z = torus(30, 20, 2.0, 0.5, 0.2).mesh.vertices.T
    assert np.hypot(np.hypot(x, y) - 2.0, z) == pytest.approx(0.5, abs=1e-14)
    assert np.abs(cube(4, 2.0).mesh.vertices).max(axis=1) == pytest.approx(1.0, abs=0)
    assert (ellipsoid(3, (1, 2, 3)).mesh.vertices ** 2 / [1, 4, 9]).sum(axis=1) == pytest.approx(1.0, abs=1e-14)


@pytest.mark.parametrize("size", [1e-4, 1.0, 1e4])
def test_flat_is_what_lies_in_a_plane_to_a_share_of_its_size(size: float) -> None:
    flat = disk(4).mesh
    turn = np.linalg.qr(np.random.default_rng(0).standard_normal((3, 3)))[0]
    assert is_flat(TriangleMesh(size * flat.vertices @ turn + 3.0 * size, flat.faces))
    bent = flat.vertices + 1e-7 * flat.vertices[:, :1] ** 2 * [0.0, 0.0, 1.0]
    assert not is_flat(TriangleMesh(size * bent @ turn + 3.0 * size, flat.faces))


def test_exact_areas_of_flat_shapes() -> None:
    assert cube(7, 3.0).mesh.area == pytest.approx(54.0, abs=1e-12)
    assert cube(7, 3.0, (11, 22, 33)).mesh.area == pytest.approx(54.0, abs=1e-12)
    assert volume(cube(3, 3.0).mesh) == pytest.approx(27.0, abs=1e-12)
    assert rectangle(5, 8, 2.0, 3.0).mesh.area == pytest.approx(6.0, abs=1e-13)


def test_vertex_counts_and_angles() -> None:
    assert [len(icosphere(k).mesh.vertices) for k in range(4)] == [12, 42, 162, 642]
    assert len(fibonacci_sphere(777).mesh.vertices) == 777
    assert len(disk(10).mesh.vertices) == 331
    assert len(cube(6).mesh.vertices) == 6 * 36 + 2
    assert abs(len(torus().mesh.vertices) - 65536) <= 0.005 * 65536
    assert icosphere(4).mesh.minimum_angle > 50
    assert disk(20).mesh.minimum_angle > 40


def test_flat_torus_tiles_the_plane_with_equal_triangles() -> None:
    for equilateral, area in ((False, 1.0), (True, np.sqrt(0.75))):
        faces, corners = flat_torus(8, equilateral)
        first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        doubled = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
        assert doubled == pytest.approx(area / 64, rel=1e-12)
        sides = np.linalg.norm(corners - corners[:, [1, 2, 0]], axis=2)
        assert np.unique(sides.round(12)).size == (1 if equilateral else 2)
        assert TriangleMesh(np.zeros((64, 3)), faces).euler_characteristic == 0


def test_jitter_is_seeded() -> None:
    first, again, other = (torus(20, 10, jitter=0.2, seed=seed).mesh.vertices for seed in (1, 1, 2))
    assert (first == again).all()
    assert not np.allclose(first, other)


def test_rotation_matrix_is_a_rotation_in_the_stated_order() -> None:
    turn = rotation_matrix((90.0, 0.0, 90.0))
    assert turn @ turn.T == pytest.approx(np.eye(3), abs=1e-15)
    assert np.linalg.det(turn) == pytest.approx(1.0)
    # about x: y goes to z, which stays about z; x goes to y
    assert turn @ [0, 1, 0] == pytest.approx([0, 0, 1], abs=1e-15)
    assert turn @ [1, 0, 0] == pytest.approx([0, 1, 0], abs=1e-15)


def test_subdivision_keeps_area_topology_and_old_vertices() -> None:
    mesh = disk(3).mesh
    finer = subdivide(mesh, levels=2)
    assert len(finer.faces) == 16 * len(mesh.faces)
    assert finer.area == pytest.approx(mesh.area, rel=1e-14)
    assert (finer.vertices[: len(mesh.vertices)] == mesh.vertices).all()
    assert finer.euler_characteristic == 1
    assert (finer.face_normals[:, 2] > 0).all()
    assert subdivide(mesh, levels=1).areas == pytest.approx(np.repeat(mesh.areas, 4) / 4, rel=1e-12)


def test_bounds_are_named() -> None:
    for make, words in [
        (lambda: icosphere(-1), "levels = -1"),
        (lambda: fibonacci_sphere(3), "count = 3"),
        (lambda: torus(2, 5), "2 x 5"),
        (lambda: torus(minor_radius=1.5), "1.5"),
        (lambda: disk(0), "rings = 0"),
        (lambda: rectangle(1, 4), "1 x 4"),
        (lambda: cube(0), "cells = 0"),
        (lambda: ellipsoid(2, (1, 0, 1)), "(1, 0, 1)"),
        (lambda: spherical_cap(4.0), "angle = 4.0"),
        (lambda: flat_torus(2), "n = 2"),
        (lambda: surface_of_revolution("vase"), "choose one of"),
        (lambda: surface_of_revolution(lambda t: np.sin(2 * t)), "positive radii"),
    ]:
        with pytest.raises(ValueError, match="^.*" + words.replace("(", r"\(").replace(")", r"\)")):
            make()


def test_normals_at_vertices_are_those_of_sphere_and_plane() -> None:
    balls = [icosphere(levels).mesh for levels in (2, 3, 4)]
    errors = [np.abs(ball.vertex_normals - ball.vertices).max() for ball in balls]
    assert errors[2] < 0.6 * errors[1] < 0.36 * errors[0]
    ball = balls[0]
    np.testing.assert_allclose(disk(4).mesh.vertex_normals, np.tile([0.0, 0.0, 1.0], (len(disk(4).mesh.vertices), 1)))
    with_one_more = TriangleMesh(np.vstack([ball.vertices, np.zeros((1, 3))]), ball.faces)
    assert not with_one_more.vertex_normals[-1].any()
