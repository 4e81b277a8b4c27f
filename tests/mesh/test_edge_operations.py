"""Collapsed edges leave no long edge and turn no face over."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.mesh.edge_operations import collapse_edges
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.triangle_mesh import TriangleMesh


@pytest.mark.parametrize("factor", [1.6, 2.5])
def test_no_edge_grows_over_the_longest_that_is_allowed(factor: float) -> None:
    mesh = icosphere(3).mesh
    lengths = np.linalg.norm(np.diff(mesh.vertices[mesh.edges], axis=1)[:, 0], axis=1)
    longest = factor * float(lengths.max())
    vertices, faces = mesh.vertices.copy(), mesh.faces.copy()
    for _ in range(6):
        vertices, faces = collapse_edges(vertices, faces, np.inf, longest, 10**6)
    coarse = TriangleMesh(vertices, faces)
    found = np.linalg.norm(np.diff(coarse.vertices[coarse.edges], axis=1)[:, 0], axis=1)
    assert found.max() <= longest * (1.0 + 1e-12)
    assert coarse.is_closed and coarse.euler_characteristic == 2 and len(vertices) < len(mesh.vertices)


def test_no_face_turns_by_more_than_sixty_degrees() -> None:
    """A sphere with noise: faces that would fold over stay."""
    mesh = icosphere(3).mesh
    rough = mesh.vertices * (1.0 + np.random.default_rng(0).uniform(-0.1, 0.1, (len(mesh.vertices), 1)))
    vertices, faces = collapse_edges(rough, mesh.faces.copy(), np.inf, np.inf, 10**6)
    coarse = TriangleMesh(vertices, faces)
    outward = (coarse.face_normals * coarse.vertices[coarse.faces].mean(axis=1)).sum(axis=1)
    assert len(vertices) < 0.95 * len(rough) and (outward > 0).all()
