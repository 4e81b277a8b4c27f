"""The published gradient: what is right about it, and its documented defects."""

import numpy as np
from scipy.sparse import diags_array

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.rectangle import flat_torus
from surfexp.mesh.shapes.torus import torus
from surfexp.operators.assembly import assemble
from surfexp.operators.diagnostics import adjointness_defect
from surfexp.operators.vertex_averaged import vertex_averaged


def published_weights(points: np.ndarray) -> np.ndarray:
    """w of (1.24) by the metric of (1.12), for the three corners of one triangle."""
    edges = np.stack([points[1] - points[0], points[2] - points[0]])
    inverse = np.linalg.inv(edges @ edges.T)
    w1, w2 = inverse[0] @ edges, inverse[1] @ edges
    return np.stack([-w1 - w2, w1, w2])


def test_agrees_with_the_formula_as_published() -> None:
    mesh = icosphere(1).mesh
    matrix = np.zeros((len(mesh.vertices), len(mesh.vertices), 3))
    for face, area in zip(mesh.faces, mesh.areas, strict=True):
        weights = published_weights(mesh.vertices[face])
        for i in face:
            matrix[i, face] += area * weights
    ring = np.bincount(mesh.faces.ravel(), np.repeat(mesh.areas, 3))
    rows = vertex_averaged(mesh).averaged_gradient
    assert rows is not None
    for x in range(3):
        assert np.abs(rows[x].toarray() - matrix[:, :, x] / ring[:, None]).max() <= 1e-12


def test_the_defect_of_the_published_pair_is_of_first_order() -> None:
    defects = [adjointness_defect(vertex_averaged(icosphere(levels).mesh)) for levels in (2, 3, 4)]
    assert np.allclose(defects, [0.48, 0.25, 0.125], rtol=0.02)


def test_on_tangent_fields_the_defect_is_of_second_order() -> None:
    meshes = [icosphere(levels).mesh for levels in (2, 3, 4)]
    for tangent in (False, True):
        defects = [adjointness_defect(vertex_averaged(mesh, tangent), mesh.vertex_normals) for mesh in meshes]
        assert (np.log2(np.array(defects[:-1]) / defects[1:]) > 1.9).all()


def test_tangent_gradients_are_perpendicular_to_the_vertex_normals() -> None:
    mesh = torus(24, 12).mesh
    operator = vertex_averaged(mesh, tangent=True)
    assert operator.averaged_gradient is not None and not operator.consistent
    f = np.random.default_rng(0).normal(size=len(mesh.vertices))
    field = np.stack([row @ f for row in operator.averaged_gradient], axis=1)
    assert np.abs((field * mesh.vertex_normals).sum(axis=1)).max() <= 1e-12 * np.abs(field).max()
    assert np.abs(np.stack([row @ np.ones_like(f) for row in operator.averaged_gradient])).max() <= 1e-12


def test_flat_periodic_grid_has_an_exact_adjoint_but_six_null_modes() -> None:
    faces, corners = flat_torus(24)
    sides = corners[:, [2, 0, 1]] - corners[:, [1, 2, 0]]
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    twice = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    hats = np.stack([-sides[..., 1], sides[..., 0]], axis=2) / twice[:, None, None]
    weighted = 0.5 * np.abs(twice)[:, None, None] * hats / 3.0
    mass = np.bincount(faces.ravel(), np.repeat(np.abs(twice) / 6.0, 3))
    gram = np.zeros((len(mass), len(mass)))
    for x in range(2):
        block = assemble(faces, weighted[:, None, :, x].repeat(3, 1), len(mass))
        assert abs(block + block.T).max() <= 1e-15
        gram += (block.T @ diags_array(1.0 / mass) @ block).toarray()
    assert (np.linalg.eigvalsh(gram) <= 1e-9).sum() == 6
