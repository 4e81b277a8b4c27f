"""Intrinsic Delaunay triangulation: the same surface, Delaunay, and robust."""

import igl
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.assembly import stiffness
from surfexp.operators.calculus import divergence, gradient, total_variation
from surfexp.operators.diagnostics import adjointness_defect, null_modes
from surfexp.operators.fem import fem
from surfexp.operators.intrinsic_delaunay import intrinsic_delaunay


def off_diagonal_maximum(operator: object) -> float:
    matrix = stiffness(operator).tocoo()
    return float(matrix.data[matrix.row != matrix.col].max())


@settings(deadline=None, max_examples=15)
@given(st.integers(0, 10**6))
def test_area_is_kept_and_the_laplacian_is_libigl_s(seed: int) -> None:
    mesh = torus(20, 10, jitter=0.24, seed=seed).mesh
    operator = intrinsic_delaunay(mesh)
    assert operator.areas.sum() == pytest.approx(mesh.area, rel=1e-12)
    assert operator.metrics["flips"] > 0 and operator.metrics["mollification"] == 0
    reference = igl.intrinsic_delaunay_cotmatrix(mesh.vertices.copy(), mesh.faces.copy())
    reference = reference[0] if isinstance(reference, tuple) else reference
    assert abs(stiffness(operator) + reference).max() <= 1e-9
    assert off_diagonal_maximum(operator) <= 1e-9


def test_delaunay_mesh_is_left_alone() -> None:
    mesh = icosphere(2).mesh
    operator = intrinsic_delaunay(mesh)
    assert operator.metrics["flips"] == 0
    f = np.sin(3 * mesh.vertices[:, 0])
    assert total_variation(operator, f) == pytest.approx(total_variation(fem(mesh), f), rel=1e-12)


def test_dirichlet_energy_falls_by_flipping() -> None:
    mesh = torus(24, 12, jitter=0.24, seed=3).mesh
    f = np.random.default_rng(0).normal(size=len(mesh.vertices))
    assert f @ (stiffness(intrinsic_delaunay(mesh)) @ f) < f @ (stiffness(fem(mesh)) @ f)


def test_pair_is_adjoint() -> None:
    operator = intrinsic_delaunay(torus(20, 10, jitter=0.24).mesh)
    rng = np.random.default_rng(1)
    f, p = rng.normal(size=operator.vertex_count), rng.normal(size=(len(operator.faces), 2))
    left = operator.areas @ (gradient(operator, f) * p).sum(axis=1)
    assert left == pytest.approx(-(operator.mass * f) @ divergence(operator, p), rel=1e-11)
    assert adjointness_defect(operator) <= 1e-14 and null_modes(operator) == 1


def test_slivers_and_faces_without_area_are_survived() -> None:
    vertices, faces = icosphere(2).mesh.vertices.copy(), icosphere(2).mesh.faces
    i, j, k = faces[10]
    vertices[i] = 0.5 * (vertices[j] + vertices[k])
    operator = intrinsic_delaunay(TriangleMesh(vertices, faces))
    assert operator.metrics["mollification"] > 0 and operator.notes
    assert np.isfinite(operator.hat_gradients).all() and (operator.areas > 0).all()
    assert off_diagonal_maximum(operator) <= 1e-6


def test_a_face_without_area_that_cannot_be_flipped_is_opened() -> None:
    """Sides 1, 1/2, 1/2, each lengthened alike, make an isosceles triangle."""
    line = TriangleMesh(np.array([[0.0, 0, 0], [1, 0, 0], [0.5, 0, 0]]), np.array([[0, 1, 2]]))
    operator = intrinsic_delaunay(line)
    base, leg = 1.0 + operator.metrics["mollification"], 0.5 + operator.metrics["mollification"]
    assert operator.areas[0] == pytest.approx(0.5 * base * np.sqrt(leg**2 - 0.25 * base**2), rel=1e-6, abs=0.0)
    assert operator.areas[0] > 0


def test_edges_that_are_not_manifold_or_oriented_are_kept() -> None:
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0.4, 1, 0], [0.4, -1, 0], [0.4, 0, 1]])
    fin = TriangleMesh(corners, np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]]))
    assert intrinsic_delaunay(fin).areas.sum() == pytest.approx(fin.area, rel=1e-12)
    flipped = icosphere(1).mesh.faces.copy()
    flipped[3] = flipped[3, ::-1]
    mesh = TriangleMesh(icosphere(1).mesh.vertices, flipped)
    assert intrinsic_delaunay(mesh).areas.sum() == pytest.approx(mesh.area, rel=1e-12)
