"""The rim of a surface with boundary, as a level set that a picture can draw."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.triangle_mesh import TriangleMesh

# where the line is, as a share of the way from the rim to the next vertex inside
INSIDE = 0.03


def barycentric(mesh: TriangleMesh, *fields: Floats) -> tuple[TriangleMesh, Floats, tuple[Floats, ...]]:
    """Divide each face into six by its middle and those of its sides.

    Parameters
    ----------
    mesh : TriangleMesh
    *fields : (n,) float64
        Linear on every face; the same functions on the finer mesh are returned.

    Returns
    -------
    mesh : TriangleMesh
    rim : (n + e + m,) float64
        1 on the boundary, 0 at all other vertices. No edge inside joins two vertices of the boundary, so that the
        level 1 - `INSIDE` is a line along it and nowhere else.
    fields : tuple of (n + e + m,) float64
    """
    n, e = len(mesh.vertices), len(mesh.edges)
    vertices = np.concatenate(
        [mesh.vertices, mesh.vertices[mesh.edges].mean(axis=1), mesh.vertices[mesh.faces].mean(1)]
    )
    middles, centres = n + mesh.face_edges, n + e + np.arange(len(mesh.faces))
    corners = [
        np.stack(sides, axis=1)
        for k in range(3)
        for sides in (
            (mesh.faces[:, k], middles[:, k], centres),
            (middles[:, k], mesh.faces[:, (k + 1) % 3], centres),
        )
    ]
    outer = mesh.edge_face_counts == 1
    rim = np.zeros(len(vertices))
    rim[mesh.edges[outer]] = 1.0
    rim[n : n + e][outer] = 1.0
    finer = tuple(np.concatenate([f, f[mesh.edges].mean(axis=1), f[mesh.faces].mean(axis=1)]) for f in fields)
    return TriangleMesh(vertices, np.concatenate(corners)), rim, finer


def without_rim(mesh: TriangleMesh, values: Floats) -> Floats:
    """Return the values, those that are 0 on a fixed rim replaced by the mean of their neighbours.

    A function that vanishes along the rim grows away from it like a function g along the rim times the distance; the
    zeros of the result near the rim are those of g, where nodal lines end, and not the rim itself. A corner whose
    neighbours all lie on the rim takes their new mean.
    """
    values = values.copy()
    first, second = mesh.edges.T
    for _ in range(2):
        known = values != 0.0
        counts = np.bincount(first, known[second], len(values)) + np.bincount(second, known[first], len(values))
        sums = np.bincount(first, values[second], len(values)) + np.bincount(second, values[first], len(values))
        values = np.where(known, values, sums / np.maximum(counts, 1.0))
    return values
