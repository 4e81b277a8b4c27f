"""Cup, hand, half double torus, cortex-like and genus-g surfaces, and the remeshing under them."""

from __future__ import annotations

import igl
import numpy as np
import pytest

from surfexp.mesh.edge_operations import collapse_edges, flip_edges, split_edges
from surfexp.mesh.shapes.cortex import cortex
from surfexp.mesh.shapes.cup import cup, cup_function
from surfexp.mesh.shapes.disk import disk
from surfexp.mesh.shapes.fibonacci_sphere import fibonacci_sphere
from surfexp.mesh.shapes.genus_surface import genus_surface, half_double_torus, row_of_tori
from surfexp.mesh.shapes.hand import hand, hand_function
from surfexp.mesh.shapes.implicit_surface import mesh_implicit, smooth_intersection, smooth_union
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.validate import validate

# function, a small count, the dissertation's count, genus, boundary loops, implicit function
SURFACES = {
    "cup": (cup, 4000, 25075, 1, 0, cup_function),
    "hand": (hand, 8000, 58875, 0, 1, hand_function),
    "half double torus": (half_double_torus, 4000, 31247, 0, 3, row_of_tori(2)),
    "M1": (lambda count: cortex("smooth", count), 15000, 39994, 0, 0, None),
    "M2": (lambda count: cortex("folded", count), 39994, 39994, 0, 0, None),
    "genus 3": (lambda count: genus_surface(3, count), 6000, 9000, 3, 0, row_of_tori(3)),
}


def check(name: str, mesh: TriangleMesh) -> None:
    _, _, _, genus, loops, implicit = SURFACES[name]
    assert (mesh.genus, len(mesh.boundary_loops), mesh.component_count) == (genus, loops, 1)
    assert validate(mesh.vertices, mesh.faces).ok
    assert mesh.minimum_angle > 20
    if implicit is None:
        # a radial graph: every face is seen from the origin, so none meets another
        assert np.linalg.det(mesh.vertices[mesh.faces]).min() > 0
    else:
        assert np.abs(implicit(mesh.vertices)).max() < 0.02 * mesh.edge_length
    if loops:
        assert (mesh.vertices[np.concatenate(mesh.boundary_loops), 2] == 0.0).all()
        assert mesh.vertices[:, 2].min() == 0.0


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name, (_, count, published, *_) in SURFACES.items() if count < published])
def test_count_topology_and_triangles(name: str) -> None:
    make, count = SURFACES[name][:2]
    mesh = make(count).mesh
    assert len(mesh.vertices) == count
    check(name, mesh)


@pytest.mark.slow
@pytest.mark.parametrize("name", SURFACES)
def test_surfaces_of_the_size_of_the_dissertation(name: str) -> None:
    make, _, count = SURFACES[name][:3]
    mesh = make(count).mesh
    assert len(mesh.vertices) == count
    check(name, mesh)


@pytest.mark.slow
def test_m2_is_folded_deeper_than_m1() -> None:
    smooth, folded = (cortex(form, 12000).mesh for form in ("smooth", "folded"))
    assert folded.area > 1.3 * smooth.area


def test_generators_are_deterministic() -> None:
    first, again = cup(3000).mesh, cup(3000).mesh
    assert (first.vertices == again.vertices).all() and (first.faces == again.faces).all()


def test_cup_is_a_cylinder_where_pictures_go() -> None:
    x, y, z = cup(4000).mesh.vertices.T
    rho = np.hypot(x, y)
    wall = (np.abs(z) < 0.9) & (rho > 0.9) & (x < 0.0)
    assert wall.sum() > 500
    assert rho[wall] == pytest.approx(1.0, abs=1e-6)


def test_volume_of_a_remeshed_ball_converges_at_second_order() -> None:
    errors = []
    for count in (500, 2000, 8000):
        mesh = mesh_implicit(
            lambda p: np.linalg.norm(p, axis=1) - 1.0, [-1.1] * 3, [1.1] * 3, 3.4 / np.sqrt(count), count
        )
        assert len(mesh.vertices) == count and mesh.genus == 0
        volume = (mesh.vertices[mesh.faces[:, 0]] * mesh.face_cross_products).sum() / 6
        errors.append(4 / 3 * np.pi - volume)
    assert min(np.log2(np.array(errors[:-1]) / errors[1:])) > 1.8


def test_boundary_of_a_slanting_cut_lies_on_the_surface_and_in_the_plane() -> None:
    mesh = mesh_implicit(
        lambda p: np.linalg.norm(p, axis=1) - 1.0, [-1.1, -1.1, 0.6], [1.1, 1.1, 1.1], 0.06, 1200, open_floor=True
    )
    rim = mesh.vertices[mesh.boundary_loops[0]]
    assert len(mesh.boundary_loops) == 1 and (rim[:, 2] == 0.6).all()
    assert np.hypot(rim[:, 0], rim[:, 1]) == pytest.approx(0.8, abs=1e-9)
    assert mesh.area == pytest.approx(2 * np.pi * 0.4, rel=2e-3)


@pytest.fixture(name="irregular")
def irregular_fixture() -> TriangleMesh:
    return fibonacci_sphere(800, 1.0, 3).mesh


def test_edge_operations_keep_the_topology(irregular: TriangleMesh) -> None:
    vertices, faces = irregular.vertices, irregular.faces
    for step in range(4):
        vertices, faces = split_edges(vertices, faces, 1.2 * irregular.edge_length, 10**6)
        vertices, faces = collapse_edges(vertices, faces, 0.8 * irregular.edge_length, np.inf, 10**6)
        faces, _ = flip_edges(vertices, faces)
        mesh = TriangleMesh(vertices, faces)
        assert mesh.genus == 0 and mesh.is_closed and validate(vertices, faces).ok, step


def test_split_is_limited_and_keeps_area(irregular: TriangleMesh) -> None:
    vertices, faces = split_edges(irregular.vertices, irregular.faces, 0.0, 17)
    assert len(vertices) == len(irregular.vertices) + 17
    assert TriangleMesh(vertices, faces).area == pytest.approx(irregular.area, rel=1e-13)


@pytest.mark.slow
def test_collapse_is_limited_and_respects_its_bounds(irregular: TriangleMesh) -> None:
    vertices, _ = collapse_edges(irregular.vertices, irregular.faces, np.inf, np.inf, 9)
    assert len(vertices) == len(irregular.vertices) - 9
    assert len(collapse_edges(irregular.vertices, irregular.faces, 0.0, np.inf, 10**6)[0]) == len(irregular.vertices)


@pytest.mark.slow
def test_flips_make_a_flat_triangulation_delaunay() -> None:
    flat = disk(8).mesh
    inside = np.linalg.norm(flat.vertices, axis=1) < 0.95
    shift = np.random.default_rng(0).uniform(-0.05, 0.05, flat.vertices.shape) * [1, 1, 0]
    moved = TriangleMesh(flat.vertices + shift * inside[:, None], flat.faces)
    assert (moved.face_normals[:, 2] > 0).all()
    faces, count, total = moved.faces, 1, 0
    while count:
        faces, count = flip_edges(moved.vertices, faces)
        total += count
    mesh = TriangleMesh(moved.vertices, faces)
    assert total > 10
    assert (mesh.face_normals[:, 2] > 0).all()
    assert mesh.area == pytest.approx(moved.area, rel=1e-13)
    assert mesh.minimum_angle >= moved.minimum_angle
    # Delaunay: the cotangents opposite an edge inside sum to no less than zero
    stiffness = igl.cotmatrix(mesh.vertices, np.array(mesh.faces)).toarray()
    interior = mesh.edges[mesh.edge_face_counts == 2]
    assert stiffness[interior[:, 0], interior[:, 1]].min() > -1e-8


def test_smooth_set_operations_are_exact_outside_their_blend() -> None:
    first, second = np.array([0.0, 1.0, 0.5]), np.array([1.0, 0.0, 0.5])
    assert smooth_union(first, second, 0.4) == pytest.approx([0.0, 0.0, 0.4])
    assert smooth_intersection(first, second, 0.4) == pytest.approx([1.0, 1.0, 0.6])


def test_bounds_are_named() -> None:
    for make, words in [
        (lambda: cup(100), "count = 100"),
        (lambda: hand(10), "count = 10"),
        (lambda: genus_surface(0), "genus = 0"),
        (lambda: half_double_torus(10), "count = 10"),
        (lambda: cortex("flat"), "form = 'flat'"),  # type: ignore[arg-type]
    ]:
        with pytest.raises(ValueError, match=words):
            make()
