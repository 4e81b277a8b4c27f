"""Tangent fields of Crouzeix and Raviart: what they hold exactly on planes, and their rate on the sphere."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.rectangle import rectangle
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.crouzeix_raviart import TangentFields, tangent_fields
from surfexp.operators.fem import fem
from surfexp.operators.intrinsic_delaunay import intrinsic_delaunay
from surfexp.operators.surface_operator import SurfaceOperator


def slanted() -> TriangleMesh:
    """A flat rectangle, moved inside its plane at random and turned in space."""
    flat, rng = rectangle(9, 7).mesh, np.random.default_rng(0)
    shift = 0.02 * rng.uniform(-1, 1, flat.vertices.shape) * [1, 1, 0]
    turn, _ = np.linalg.qr(rng.standard_normal((3, 3)))
    return TriangleMesh((flat.vertices + shift) @ (turn * np.sign(np.linalg.det(turn))).T, flat.faces)


def coordinates(mesh: TriangleMesh, fields: TangentFields, vectors: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Coordinates along and across the edges of vectors in space at their middles."""
    along = mesh.vertices[fields.edges[:, 1]] - mesh.vertices[fields.edges[:, 0]]
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    across = np.cross(normals, along)
    return np.stack([(vectors * along).sum(axis=1), (vectors * across).sum(axis=1)], axis=1).ravel()


def in_space(operator: SurfaceOperator, rows: np.ndarray) -> np.ndarray:
    """Vectors of the faces' frames in space."""
    assert operator.frames is not None
    return np.einsum("fa,fax->fx", rows.reshape(-1, 2), operator.frames)


@given(st.integers(0, 2**31))
def test_linear_fields_of_a_plane_are_exact(seed: int) -> None:
    mesh, rng = slanted(), np.random.default_rng(seed)
    operator = fem(mesh)
    fields, normal = tangent_fields(operator), mesh.face_normals[0]
    slope, shift = rng.standard_normal((2, 3, 3)), rng.standard_normal(3)
    project = np.eye(3) - np.outer(normal, normal)
    slope = project @ slope[0] @ project
    middles = mesh.vertices[fields.edges].mean(axis=1)
    field = coordinates(mesh, fields, middles @ slope.T + shift @ project, np.tile(normal, (len(middles), 1)))
    centres = mesh.vertices[mesh.faces].mean(axis=1)
    means = in_space(operator, fields.averages @ field)
    np.testing.assert_allclose(means, centres @ slope.T + shift @ project, atol=1e-12)
    derivative = (fields.derivative @ field).reshape(-1, 2, 2)
    expected = np.einsum("fax,xy,fby->fab", operator.frames, slope, operator.frames)
    np.testing.assert_allclose(derivative, expected, atol=1e-11)


@pytest.mark.parametrize("turning", [False, True])
def test_derivative_of_known_fields_on_the_sphere_at_their_rates(turning: bool) -> None:
    """|Hess z|^2 = 2 z^2 and |D (e_z x X)|^2 = 2 z^2, integral 8 pi / 3; one is symmetric, one the opposite."""
    errors, others = [], []
    for levels in (2, 3, 4):
        mesh = icosphere(levels).mesh
        operator = fem(mesh)
        fields = tangent_fields(operator)
        middles = mesh.vertices[fields.edges].mean(axis=1)
        middles /= np.linalg.norm(middles, axis=1, keepdims=True)
        vectors = np.cross([0.0, 0.0, 1.0], middles) if turning else [0.0, 0.0, 1.0] - middles[:, 2:] * middles
        derivative = (fields.derivative @ coordinates(mesh, fields, vectors, middles)).reshape(-1, 2, 2)
        errors.append(abs(operator.areas @ (derivative**2).sum(axis=(1, 2)) - 8 * np.pi / 3))
        other = derivative + (1 if turning else -1) * derivative.transpose(0, 2, 1)
        others.append(np.sqrt(operator.areas @ (other**2).sum(axis=(1, 2))))
    np.testing.assert_allclose(np.array(errors[:-1]) / np.array(errors[1:]), 4.0, atol=0.4)
    assert np.all(np.array(others[1:]) < np.array(others[:-1]) / 1.8 + 1e-12)


def test_nothing_depends_on_how_vertices_are_numbered() -> None:
    mesh, rng = icosphere(2).mesh, np.random.default_rng(0)
    order = rng.permutation(len(mesh.vertices))
    other = TriangleMesh(mesh.vertices[np.argsort(order)], order[mesh.faces])
    sizes = []
    for surface in (mesh, other):
        fields = tangent_fields(fem(surface))
        middles = surface.vertices[fields.edges].mean(axis=1)
        field = coordinates(surface, fields, np.sin(3 * middles[:, [1, 2, 0]]), middles)
        sizes.append(np.linalg.norm((fields.derivative @ field).reshape(-1, 4), axis=1))
    np.testing.assert_allclose(sizes[0], sizes[1], atol=1e-12)


def test_no_embedding_is_needed_and_edges_of_many_faces_are_refused() -> None:
    mesh = slanted()
    fields = tangent_fields(intrinsic_delaunay(mesh))
    assert fields.derivative.shape == (4 * len(mesh.faces), 2 * len(fields.edges))
    fan = TriangleMesh(np.vstack([np.eye(3), -np.eye(3)[:2]]), np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]]))
    with pytest.raises(ValueError, match=r"edge \[0, 1\] has 3 faces in operator 'fem', at most 2 can carry"):
        tangent_fields(fem(fan))
