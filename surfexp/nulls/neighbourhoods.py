"""The nearest vertices of each vertex, by distance along the surface."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.smoothing.geodesic_gaussian import near_distances

WIDER = 1.6


def nearest_along_surface(mesh: TriangleMesh, count: int) -> tuple[Integers, Floats]:
    """Return the nearest vertices of each vertex by the distances of `near_distances`, itself first.

    Parameters
    ----------
    mesh : TriangleMesh
    count : int
        How many, k, with the vertex itself.

    Returns
    -------
    (n, k) int64
        Vertices by increasing distance; of equal ones the lower number first.
    (n, k) float64
        Their distances, in the unit of the mesh.

    Raises
    ------
    ValueError
        If k is not in 1..n, or a component has fewer vertices.
    """
    n = len(mesh.vertices)
    smallest = int(np.bincount(mesh.component_labels).min())
    if not 1 <= count <= smallest:
        raise ValueError(
            f"{count} nearest vertices are asked for, the smallest component has {smallest}: 1..{smallest} can be had"
        )
    limit = 1.8 * float(np.sqrt(mesh.areas.sum() * count / (n * np.pi)))
    distances = near_distances(mesh, limit)
    while int(np.diff(distances.indptr).min()) < count:
        limit *= WIDER
        distances = near_distances(mesh, limit)
    neighbours, lengths = np.empty((n, count), dtype=np.int64), np.empty((n, count))
    for vertex in range(n):
        row = slice(distances.indptr[vertex], distances.indptr[vertex + 1])
        order = np.argsort(distances.data[row], kind="stable")[:count]
        neighbours[vertex], lengths[vertex] = distances.indices[row][order], distances.data[row][order]
    return neighbours, lengths
