"""Distance to the boundary, flux, weights and the Hamilton-Jacobi skeleton."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.rectangle import rectangle
from surfexp.mesh.shapes.strip import strip, y_patch
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.fem import fem
from surfexp.skeleton.boundary_distance import boundary_distance, boundary_vertices, halve_boundary_edges
from surfexp.skeleton.eigenmap import eigenmap
from surfexp.skeleton.fast_marching import fast_marching
from surfexp.skeleton.flux import (
    flux,
    flux_weights,
    skeleton_points,
    vertex_gradients,
    weight_far_from_boundary,
    weighted_operator,
)
from surfexp.skeleton.hamilton_jacobi import _spanning_edges, hamilton_jacobi_skeleton
from surfexp.skeleton.skeleton import CAP, CONTOUR, JUNCTION

FLAT = rectangle(61, 25, 2.5, 1.0).mesh
H = FLAT.edge_length
X, Y = FLAT.vertices[:, 0], FLAT.vertices[:, 1]
TRUE = np.minimum(np.minimum(X, 2.5 - X), np.minimum(Y, 1.0 - Y))


@pytest.mark.parametrize(("method", "least"), [("fast_marching", 0.05), ("exact", 0.01), ("heat", 0.6)])
def test_distance_to_the_edge_of_a_rectangle(method, least):
    pytest.importorskip({"exact": "pygeodesic", "heat": "potpourri3d"}.get(method, "numpy"))
    found = boundary_distance(FLAT, method)
    assert np.abs(found - TRUE).mean() < least * H and (found[boundary_vertices(FLAT)] == 0).all()


def test_fast_marching_converges_to_arcs_on_the_sphere():
    errors = []
    for levels in (3, 4, 5):
        mesh = icosphere(levels).mesh
        arcs = np.arccos(np.clip(mesh.vertices @ mesh.vertices[0], -1, 1))
        errors.append(np.abs(fast_marching(mesh, np.array([0])) - arcs).mean())
    assert errors[0] > 1.35 * errors[1] > 1.8 * errors[2] and errors[2] < 0.02


def test_fast_marching_does_not_depend_on_the_numbers_of_vertices() -> None:
    """As the front takes vertices in the order of their distance, whatever stands where in the heap."""
    mesh, random = torus(40, 16, jitter=0.3, seed=1).mesh, np.random.default_rng(0)
    expected = fast_marching(mesh, np.array([5, 300]))
    for _ in range(5):
        place = random.permutation(len(mesh.vertices))
        vertices = np.empty_like(mesh.vertices)
        vertices[place] = mesh.vertices
        found = fast_marching(TriangleMesh(vertices, place[mesh.faces]), place[[5, 300]])
        assert found[place] == pytest.approx(expected, rel=1e-12)


def test_fast_marching_is_a_distance_on_unconnected_and_unfit_input():
    one = icosphere(1).mesh
    two = TriangleMesh(np.concatenate([one.vertices, one.vertices + 5.0]), np.concatenate([one.faces, one.faces + 42]))
    found = fast_marching(two, np.array([3]))
    assert np.isfinite(found[:42]).all() and np.isinf(found[42:]).all() and found[3] == 0
    with pytest.raises(ValueError, match="at least 1"):
        fast_marching(two, np.array([], dtype=np.int64))


def test_halving_the_boundary_keeps_the_surface():
    mesh = strip(12.0, 4.0, 0.6).mesh
    finer, boundary = halve_boundary_edges(mesh, 2)
    assert np.array_equal(finer.vertices[: len(mesh.vertices)], mesh.vertices)
    assert finer.area == pytest.approx(mesh.area) and finer.euler_characteristic == 1
    assert len(boundary) == 4 * len(boundary_vertices(mesh))


def test_gradients_and_flux_of_a_ridge():
    gradients = vertex_gradients(fem(FLAT), X + 2 * Y)
    assert np.allclose(gradients, [1.0, 2.0, 0.0])
    ridge = 0.5 - np.abs(Y - 0.5)
    found = flux(FLAT, ridge)
    on_ridge = (np.abs(Y - 0.5) < 1e-9) & (X > 0.1) & (X < 2.4)
    elsewhere = (np.abs(Y - 0.5) > 2.5 * H) & (Y > 0.1) & (Y < 0.9) & (X > 0.1) & (X < 2.4)
    assert np.abs(found[elsewhere]).max() < 1e-9
    # above and below the gradient points at the ridge: an edge takes in the sine of its angle with it
    steps = np.diff(FLAT.vertices[FLAT.edges], axis=1)[:, 0]
    sines = np.abs(steps[:, 1]) / np.linalg.norm(steps, axis=1)
    for vertex in np.flatnonzero(on_ridge):
        assert found[vertex] == pytest.approx(-sines[(FLAT.edges == vertex).any(axis=1)].mean(), abs=1e-12)
    assert on_ridge.sum() > 50


def test_least_flux_is_on_the_skeleton_of_a_rectangle():
    found = skeleton_points(FLAT, flux(FLAT, TRUE))
    nearest = np.sort(np.stack([X, 2.5 - X, Y, 1.0 - Y]), axis=0)
    # two sides are equally near on the skeleton: the middle line and the bisectors of the corners
    assert len(found) >= 6 and (nearest[1] - nearest[0])[found].max() < 1.5 * H
    assert len(skeleton_points(FLAT, flux(FLAT, TRUE), -0.99)) < len(found)
    values = np.where(np.arange(len(X)) == 700, -0.9, -0.5)
    assert 700 in skeleton_points(FLAT, values)
    around = FLAT.edges[(FLAT.edges == 700).any(axis=1)].sum(axis=1) - 700
    assert not np.isin(around, skeleton_points(FLAT, values)).any()
    with pytest.raises(ValueError, match="negative"):
        skeleton_points(FLAT, values, 0.1)


def test_weights_are_those_of_the_text_and_bounded():
    values = np.array([-1.0, -0.25, 0.0, 0.25, 1.0])
    assert np.allclose(flux_weights(values, 0.5), np.exp([1.0, 0.5, 0.0, -0.5, -1.0]))
    assert np.allclose(flux_weights(values, 0.5, 3.0), np.exp([3.0, 1.5, 0.0, -1.5, -3.0]))
    with pytest.raises(ValueError, match="above 0"):
        flux_weights(values, 0.0)


def test_the_weighted_operator_has_the_weighted_stiffness_and_the_plain_mass():
    mesh, plain = strip(12.0, 4.0, 0.6).mesh, fem(strip(12.0, 4.0, 0.6).mesh)
    weights = np.exp(np.sin(mesh.vertices[:, 0]))
    found = weighted_operator(plain, weights)
    f = np.cos(mesh.vertices[:, 1])
    local = np.einsum("fia,fi->fa", plain.hat_gradients, f[mesh.faces])
    energy = (weights[mesh.faces].mean(axis=1) * plain.areas * (local**2).sum(axis=1)).sum()
    assert f @ (stiffness(found) @ f) == pytest.approx(energy)
    assert abs(mass_matrix(found) - mass_matrix(plain)).max() == 0
    with pytest.raises(ValueError, match="positive"):
        weighted_operator(plain, -weights)


def test_the_eigenvalue_of_a_rectangle_with_weight_two():
    operator = weighted_operator(fem(FLAT), np.full(len(X), 2.0))
    found = eigenmap(operator)
    assert found.metrics["eigenvalue"] == pytest.approx(2.0 * (np.pi / 2.5) ** 2, rel=2e-3)
    cosine = np.cos(np.pi * X / 2.5)
    assert abs(np.corrcoef(found.values, cosine)[0, 1]) > 0.999999


@pytest.mark.parametrize(("index", "gap"), [(1, 1.0), (2, 0.36 / 0.64), (3, 0.16), (4, 0.16 / 1.16)])
def test_the_gap_is_that_to_the_nearest_eigenvalue_on_either_side(index: int, gap: float) -> None:
    """Of the rectangle they are 0, 0.16, 0.64, 1, 1.16 and 1.44 times the square of pi."""
    assert eigenmap(fem(FLAT), index).metrics["gap"] == pytest.approx(gap, rel=0.02)


def test_hamilton_jacobi_keeps_topology_and_finds_three_arms():
    y = y_patch().mesh
    skeleton = hamilton_jacobi_skeleton(y, boundary_distance(y), -0.5)
    assert (skeleton.metrics["leaves"], skeleton.metrics["b1"], skeleton.metrics["components"]) == (3, 0, 1)
    degrees = np.bincount(skeleton.arcs.ravel(), minlength=len(skeleton.kinds))
    assert {kind: set(degrees[skeleton.kinds == kind]) for kind in (CAP, CONTOUR, JUNCTION)} == {
        CAP: {1},
        CONTOUR: {2},
        JUNCTION: {3},
    }
    ring = torus(40, 16).mesh
    faces = ring.faces[ring.vertices[ring.faces][:, :, 2].mean(axis=1) > 0.05]
    used, numbered = np.unique(faces, return_inverse=True)
    annulus = TriangleMesh(ring.vertices[used], numbered.reshape(-1, 3))
    found = hamilton_jacobi_skeleton(annulus, boundary_distance(annulus), -0.99)
    assert found.metrics["b1"] == 1 and found.metrics["components"] == 1


def test_closed_surfaces_have_no_distance_to_a_boundary():
    with pytest.raises(ValueError, match="is closed"):
        boundary_distance(icosphere(2).mesh)
    with pytest.raises(ValueError, match="negative"):
        hamilton_jacobi_skeleton(FLAT, TRUE, 0.3)
    with pytest.raises(ValueError, match="fast_marching, exact, heat"):
        boundary_distance(FLAT, "dijkstra")


def test_points_on_the_midline_of_a_rectangle_have_more_weight() -> None:
    mesh = rectangle(61, 25, 2.5, 1.0).mesh
    distance = boundary_distance(mesh)
    weights = flux_weights(flux(mesh, distance), 0.5)
    assert weight_far_from_boundary(mesh, weights, distance) > 1.1
    assert weight_far_from_boundary(mesh, 1.0 / weights, distance) < 1.0
    assert weight_far_from_boundary(mesh, np.ones(len(distance)), distance) == pytest.approx(1.0)


def test_the_weight_of_the_farthest_tenth_beside_the_mean() -> None:
    # 1 + x is 1 + 2.375 in the mean from 2.25 to 2.5, and 2.25 in the mean from 0 to 2.5
    assert weight_far_from_boundary(FLAT, 1.0 + X, X) == pytest.approx(3.375 / 2.25, rel=0.02)


def test_of_a_face_that_is_kept_whole_the_longest_side_goes():
    mesh = TriangleMesh(np.array([[0.0, 0, 0], [3, 0, 0], [0, 4, 0], [9, 9, 0]]), np.array([[0, 1, 2], [1, 3, 2]]))
    kept = np.array([True, True, True, False])
    edges = _spanning_edges(mesh, kept, np.arange(4))
    assert sorted(map(sorted, edges.tolist())) == [[0, 1], [0, 2]]
