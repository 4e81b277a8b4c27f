"""The nearest vertices of each vertex, by distance along the surface."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.nulls.nearest_search import nearest_searches
from surfexp.smoothing.geodesic_gaussian import surface_graph


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
    graph = surface_graph(mesh)
    starts, ends = graph.indptr.astype(np.int64), graph.indices.astype(np.int64)
    return nearest_searches(starts, ends, graph.data, np.arange(n), count)
