"""A shuffled metric keeps lengths and triangles, and nothing of the geometry."""

import numpy as np
import pytest

from surfexp.mesh.shapes.ellipsoid import ellipsoid
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.assembly import stiffness
from surfexp.operators.fem import fem
from surfexp.operators.shuffled_lengths import shuffled_lengths

MESH = ellipsoid(3, (1.0, 1.3, 2.0)).mesh


def side_lengths(operator) -> np.ndarray:
    """Lengths of the sides opposite to each corner, read back from areas and gradients: |grad e_k| = side / (2 A)."""
    return np.linalg.norm(operator.hat_gradients, axis=2) * 2.0 * operator.areas[:, None]


def test_lengths_are_those_of_the_mesh_in_another_order() -> None:
    operator = shuffled_lengths(MESH, seed=5)
    opposite = MESH.face_edges[:, [1, 2, 0]]
    lengths = np.empty(len(MESH.edges))
    sides = side_lengths(operator)
    lengths[opposite] = sides
    # both faces of an edge agree on its length
    np.testing.assert_allclose(lengths[opposite], sides, rtol=1e-9)
    before = np.linalg.norm(np.diff(MESH.vertices[MESH.edges], axis=1)[:, 0], axis=1)
    np.testing.assert_allclose(np.sort(lengths), np.sort(before), rtol=1e-9)
    assert operator.metrics["correlation"] == pytest.approx(np.corrcoef(lengths, before)[0, 1])
    assert abs(operator.metrics["correlation"]) < 0.1 and operator.metrics["moved"] > 0.95
    assert operator.metrics["moved"] == pytest.approx(np.mean(~np.isclose(lengths, before, rtol=1e-9)), abs=1e-3)


def test_no_triangle_is_thinner_than_the_thinnest_and_constants_have_no_energy() -> None:
    operator = shuffled_lengths(MESH, seed=1)
    after, before = side_lengths(operator), side_lengths(fem(MESH))
    slack = [(sides.sum(axis=1) / sides.max(axis=1) - 2.0).min() for sides in (after, before)]
    assert slack[0] >= slack[1] - 1e-9 > 0.1
    matrix = stiffness(operator)
    assert abs(matrix.sum(axis=1)).max() < 1e-10 and np.linalg.eigvalsh(matrix.toarray())[0] > -1e-10
    assert 0.0 < operator.metrics["accepted"] < 1.0


def test_equal_lengths_stay_and_seeds_and_sweeps_matter() -> None:
    tetrahedron = TriangleMesh(
        np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]),
        np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]),
    )
    np.testing.assert_allclose(shuffled_lengths(tetrahedron).areas, tetrahedron.areas)
    # every exchange of equal lengths is allowed, but for an edge with itself
    pairs = np.random.default_rng(3).integers(6, size=(600, 2))
    metrics = shuffled_lengths(tetrahedron, 3).metrics
    assert metrics["accepted"] == pytest.approx(np.mean(pairs[:, 0] != pairs[:, 1]), abs=1e-12)
    assert metrics["moved"] == 0.0 and metrics["correlation"] == 1.0
    flat = TriangleMesh(tetrahedron.vertices[[0, 1, 2, 0]], tetrahedron.faces)
    with pytest.raises(ValueError, match="has area 0"):
        shuffled_lengths(flat)
    ring = torus(20, 10).mesh
    one, two, same = (shuffled_lengths(ring, seed).areas for seed in (0, 1, 0))
    assert np.array_equal(one, same) and not np.array_equal(one, two)
    few = [shuffled_lengths(MESH, 0, sweeps).metrics["correlation"] for sweeps in (1, 10)]
    assert few[0] > few[1] + 0.1
    with pytest.raises(ValueError, match="sweeps = 0"):
        shuffled_lengths(ring, 0, 0)
