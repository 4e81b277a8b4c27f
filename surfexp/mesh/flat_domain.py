"""Meshes that lie in a plane: whether they do, and the corners of their boundary."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.triangle_mesh import TriangleMesh


def is_flat(mesh: TriangleMesh, tolerance: float = 1e-9) -> bool:
    """Whether all vertices lie in one plane, to a share of the extent."""
    centred = mesh.vertices - mesh.vertices.mean(axis=0)
    normal = np.linalg.eigh(centred.T @ centred)[1][:, 0]
    return bool(np.abs(centred @ normal).max() <= tolerance * np.abs(centred).max())


def boundary_angles(mesh: TriangleMesh, straight: float = 1e-6) -> Floats:
    """Return the inner angles at the boundary vertices of a flat domain that differ from pi by more than `straight`."""
    angles = np.zeros(len(mesh.vertices))
    corners = mesh.vertices[mesh.faces]
    for k in range(3):
        first, second = corners[:, (k + 1) % 3] - corners[:, k], corners[:, (k + 2) % 3] - corners[:, k]
        cosine = np.einsum("ij,ij->i", first, second) / np.linalg.norm(first, axis=1) / np.linalg.norm(second, axis=1)
        np.add.at(angles, mesh.faces[:, k], np.arccos(np.clip(cosine, -1.0, 1.0)))
    boundary = np.unique(np.concatenate(mesh.boundary_loops))
    return angles[boundary][np.abs(angles[boundary] - np.pi) > straight]
