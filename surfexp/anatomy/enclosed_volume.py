"""The volume inside a closed surface."""

from __future__ import annotations

import numpy as np

from surfexp.mesh.triangle_mesh import TriangleMesh


def enclosed_volume(mesh: TriangleMesh) -> float:
    """Return the volume inside a closed mesh, positive where its faces look outward."""
    a, b, c = (mesh.vertices[mesh.faces[:, k]] - mesh.vertices[0] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)
