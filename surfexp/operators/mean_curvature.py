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
    contains the curvature of the boundary, the value is the mean of its interior neighbours; where it has none, as at a
    corner of a patch, of the neighbours that have such a mean; and NaN where there are none either, as on strips one face wide.

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
    """Give a vertex of the boundary the mean of its neighbours inside, or else of those that were given one."""
    known = np.ones(len(curvature), dtype=bool)
    known[mesh.edges[mesh.edge_face_counts == 1]] = False
    values = np.where(known, curvature, np.nan)
    here, there = np.concatenate([mesh.edges, mesh.edges[:, ::-1]]).T
    for _ in ("beside the inside", "beside these"):
        reached = ~known[here] & known[there]
        count = np.bincount(here[reached], minlength=len(known))
        total = np.bincount(here[reached], values[there[reached]], len(known))
        values[count > 0] = total[count > 0] / count[count > 0]
        known |= count > 0
    return values
