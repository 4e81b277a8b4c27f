"""Midpoint subdivision: every triangle becomes four."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.triangle_mesh import TriangleMesh


def subdivide(mesh: TriangleMesh, project: Callable[[Floats], Floats] | None = None, levels: int = 1) -> TriangleMesh:
    """Split every face into four at its edge midpoints.

    Parameters
    ----------
    mesh : TriangleMesh
        Non-manifold meshes are allowed.
    project : callable, optional
        Takes (k, 3) points near a known shape to points on it; applied to the new vertices only.
    levels : int
        How often; the number of faces grows by 4 each time.

    Returns
    -------
    TriangleMesh
        The old vertices come first, in their order; then one for each edge, in the order of `edges`. Faces 4i..4i+3
        come from face i.
    """
    for _ in range(levels):
        midpoints = mesh.vertices[mesh.edges].mean(axis=1)
        if project is not None:
            midpoints = project(midpoints)
        a, b, c = mesh.faces.T
        ab, bc, ca = (mesh.face_edges + len(mesh.vertices)).T
        corners = np.stack([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], axis=1)
        mesh = TriangleMesh(np.concatenate([mesh.vertices, midpoints]), corners.reshape(-1, 3))
    return mesh
