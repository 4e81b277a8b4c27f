"""Mean curvature at the vertices from the cotangent Laplacian of the positions."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.assembly import stiffness
from surfexp.operators.fem import fem


def mean_curvature(mesh: TriangleMesh) -> Floats:
    """Return H = (k1 + k2)/2 at the vertices, in the inverse unit of the mesh.

    From Q x = 2 H n M, area-normalised with the lumped mass. With faces counter-clockwise seen from outside H is
    positive where the surface bulges outward (1/r on a sphere), so on a cortex gyri are positive and sulci negative:
    the opposite sign of FreeSurfer's `curv` map, which is positive in sulci. On a boundary vertex, where the formula also
    contains the curvature of the boundary, the value is the mean of its interior neighbours.

    Parameters
    ----------
    mesh : TriangleMesh

    Returns
    -------
    (n,) float64

    References
    ----------
    Meyer, Desbrun, Schroder, Barr: Discrete differential-geometry operators for triangulated 2-manifolds (2003).
    """
    operator = fem(mesh)
    laplacian = (stiffness(operator) @ mesh.vertices) / operator.mass[:, None]
    curvature = 0.5 * np.einsum("ix,ix->i", laplacian, mesh.vertex_normals)
    return _fill_boundary(mesh, curvature)


def _fill_boundary(mesh: TriangleMesh, curvature: Floats) -> Floats:
    boundary = np.zeros(len(mesh.vertices), dtype=bool)
    boundary[mesh.edges[mesh.edge_face_counts == 1]] = True
    total, count = np.zeros(len(boundary)), np.zeros(len(boundary))
    for here, there in (mesh.edges.T, mesh.edges.T[::-1]):
        inside = boundary[here] & ~boundary[there]
        np.add.at(total, here[inside], curvature[there[inside]])
        np.add.at(count, here[inside], 1.0)
    return np.where(boundary, np.divide(total, count, out=np.zeros_like(total), where=count > 0), curvature)
