"""Linear elements: adjointness, exactness on linear functions, agreement with libigl, what is refused."""

import igl
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.rectangle import rectangle
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.calculus import adjoint_gradient, divergence, gradient, gradient_matrix, total_variation
from surfexp.operators.diagnostics import adjointness_defect, null_modes
from surfexp.operators.fem import fem
from surfexp.operators.libigl_operator import libigl_operator

TORUS = torus(24, 12, jitter=0.2).mesh


@settings(deadline=None, max_examples=20)
@given(st.integers(0, 10**6), st.integers(1, 3))
def test_divergence_is_the_negative_adjoint_of_the_gradient(seed: int, channels: int) -> None:
    operator, rng = fem(TORUS), np.random.default_rng(seed)
    f = rng.normal(size=(operator.vertex_count, channels))
    p = rng.normal(size=(len(operator.faces), channels, 2))
    left = np.einsum("f,fca,fca->", operator.areas, gradient(operator, f), p)
    right = np.einsum("i,ic,ic->", operator.mass, f, divergence(operator, p))
    assert abs(left + right) <= 1e-12 * abs(np.einsum("f,fca->", operator.areas, np.abs(gradient(operator, f) * p)))
    assert np.allclose(adjoint_gradient(operator, p), -operator.mass[:, None] * divergence(operator, p))


def test_defect_and_null_modes_of_the_adjoint_pair() -> None:
    assert adjointness_defect(fem(TORUS)) <= 1e-14
    assert null_modes(fem(TORUS)) == 1


def test_gradient_in_space_is_that_of_a_linear_function() -> None:
    mesh = rectangle(9, 7, 1.5, 1.0).mesh
    operator = fem(mesh)
    slope = np.array([0.7, -2.0, 0.0])
    assert operator.frames is not None
    in_space = np.einsum("fa,fax->fx", gradient(operator, mesh.vertices @ slope), operator.frames)
    assert np.abs(in_space - slope).max() <= 1e-12
    area = 1.5 * 1.0
    assert total_variation(operator, mesh.vertices @ slope) == pytest.approx(np.hypot(0.7, 2.0) * area, rel=1e-13)


def test_frames_are_orthonormal_and_tangent() -> None:
    frames = fem(TORUS).frames
    assert frames is not None
    assert np.abs(np.einsum("fax,fbx->fab", frames, frames) - np.eye(2)).max() <= 1e-12
    assert np.abs(np.einsum("fax,fx->fa", frames, TORUS.face_normals)).max() <= 1e-12


def test_libigl_agrees() -> None:
    ours, theirs = fem(TORUS), libigl_operator(TORUS)
    assert np.abs(ours.areas - theirs.areas).max() <= 1e-12 * ours.areas.max()
    assert np.abs(ours.hat_gradients - theirs.hat_gradients).max() <= 1e-12 * np.abs(ours.hat_gradients).max()
    cotangents = igl.cotmatrix(TORUS.vertices.copy(), TORUS.faces.copy())
    assert abs(stiffness(ours) + cotangents).max() <= 1e-12 * abs(cotangents).max()
    full = igl.massmatrix(TORUS.vertices.copy(), TORUS.faces.copy(), igl.MASSMATRIX_TYPE_FULL)
    assert abs(mass_matrix(ours) - full).max() <= 1e-12 * abs(full).max()


def test_stiffness_is_the_product_of_gradient_and_adjoint() -> None:
    operator = fem(TORUS)
    matrix = gradient_matrix(operator)
    product = matrix.T @ (np.repeat(operator.areas, 2)[:, None] * matrix.toarray())
    assert np.abs(stiffness(operator).toarray() - product).max() <= 1e-12


def test_remark_2_3_2_mass_is_definite_and_stiffness_semidefinite() -> None:
    operator = fem(icosphere(1).mesh)
    mass, stiff = mass_matrix(operator).toarray(), stiffness(operator).toarray()
    assert np.abs(mass - mass.T).max() == 0 and np.abs(stiff - stiff.T).max() <= 1e-15
    assert np.linalg.eigvalsh(mass)[0] > 0
    values = np.linalg.eigvalsh(stiff)
    assert abs(values[0]) <= 1e-13 and values[1] > 0.01
    assert np.allclose(mass.sum(axis=1), operator.mass, rtol=1e-13)


def test_gradient_and_divergence_converge_at_first_order() -> None:
    errors = []
    for levels in (2, 3, 4):
        mesh = icosphere(levels).mesh
        operator = fem(mesh)
        f = mesh.vertices[:, 2]
        centres = mesh.vertices[mesh.faces].mean(axis=1)
        exact = np.array([0, 0, 1.0]) - centres[:, 2:] * centres / (centres**2).sum(axis=1, keepdims=True)
        in_space = np.einsum("fa,fax->fx", gradient(operator, f), operator.frames)
        errors.append(np.sqrt(operator.areas @ ((in_space - exact) ** 2).sum(axis=1)))
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (rates > 0.9).all()


def test_bad_meshes_are_refused_by_name() -> None:
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    with pytest.raises(ValueError, match="0 faces"):
        fem(TriangleMesh(square, np.zeros((0, 3), dtype=np.int64)))
    with pytest.raises(ValueError, match="vertex 3 belongs to no face"):
        fem(TriangleMesh(square, np.array([[0, 1, 2]])))
    with pytest.raises(ValueError, match="vertex 2 is at"):
        fem(TriangleMesh(np.vstack([square[:2], [[np.nan, 1, 0]], square[3:]]), np.array([[0, 1, 2], [0, 2, 3]])))
    with pytest.raises(ValueError, match="face 1 has area 0"):
        fem(TriangleMesh(np.vstack([square[:3], [2.0, 2, 0]]), np.array([[0, 1, 2], [0, 2, 3]])))
    with pytest.raises(ValueError, match="5 entries, the operator has"):
        gradient(fem(TORUS), np.zeros(5))
