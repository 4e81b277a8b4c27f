"""Means weighted by a Gaussian of the distance along the surface: the smoothing of imaging packages, in the open."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array, diags_array, vstack
from scipy.sparse.csgraph import dijkstra

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.edge_table import edge_table
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.variational.separable_quadratic import check_positive

# full width at half maximum over standard deviation
WIDTH_OF_DEVIATION = float(np.sqrt(8.0 * np.log(2.0)))
REACH = 4.0
ROWS_AT_ONCE = 500


def surface_graph(mesh: TriangleMesh) -> csr_array:
    """Return the graph of edges and unfolded diagonals that `near_distances` searches, each link in both directions.

    Parameters
    ----------
    mesh : TriangleMesh

    Returns
    -------
    (n, n) csr_array
        Lengths in the unit of the vertices.
    """
    tails, heads, lengths = _links(mesh.vertices, mesh.faces)
    count = len(mesh.vertices)
    once = csr_array((lengths, (tails, heads)), shape=(count, count))
    return csr_array(once + once.T)


def near_distances(mesh: TriangleMesh, limit: float, sources: Integers | None = None) -> csr_array:
    """Return the distances of all pairs of vertices that are nearer than a limit.

    Shortest paths along edges and along the other diagonal of two neighbouring triangles, unfolded into the plane, where
    it stays within them; they exceed the distance on the mesh by a few per cent.

    Parameters
    ----------
    mesh : TriangleMesh
    limit : float
        In the unit of the vertices.
    sources : (s,) int64, optional
        Vertices whose rows are wanted, all if not given.

    Returns
    -------
    (s, n) csr_array
        Symmetric where all are wanted; the zero of each vertex to itself is stored.

    Raises
    ------
    ValueError
        If the limit is not positive.
    """
    check_positive("limit", limit)
    count = len(mesh.vertices)
    graph = surface_graph(mesh)
    wanted = np.arange(count) if sources is None else sources
    blocks = []
    for start in range(0, len(wanted), ROWS_AT_ONCE):
        distances = dijkstra(graph, indices=wanted[start : start + ROWS_AT_ONCE], limit=limit)
        near = np.isfinite(distances)
        starts = np.concatenate([[0], np.cumsum(near.sum(axis=1))])
        blocks.append(csr_array((distances[near], np.nonzero(near)[1], starts), shape=distances.shape))
    return csr_array(vstack(blocks))


def geodesic_gaussian(distances: csr_array, areas: Floats, values: Floats, width: float) -> Floats:
    """Return means of a map weighted by area and by a Gaussian of the distance, cut off at four deviations.

    The mean over the area is not kept, and near a boundary the kernel is cut and divided by what is left of it.

    Parameters
    ----------
    distances : (n, n) csr_array
        Of `near_distances`.
    areas : (n,) float64
        Of the vertices.
    values : (n,) or (n, c) float64
    width : float
        Full width at half maximum, in the unit of the distances, whose limit is 1.7 times this or more.

    Returns
    -------
    like `values`

    Raises
    ------
    ValueError
        If the width is not positive.

    References
    ----------
    Marcus et al.: Informatics and data mining tools and strategies for the Human Connectome Project (2011).
    """
    check_positive("width", width)
    deviation = width / WIDTH_OF_DEVIATION
    scaled = distances.data / deviation
    weights = np.where(scaled <= REACH, np.exp(-0.5 * scaled**2), 0.0)
    kernel = csr_array((weights, distances.indices, distances.indptr), shape=distances.shape) @ diags_array(areas)
    total = kernel.sum(axis=1)
    return np.asarray(kernel @ values) / total.reshape(-1, *[1] * (values.ndim - 1))


def _links(vertices: Floats, faces: Integers) -> tuple[Integers, Integers, Floats]:
    """Ends and lengths of the edges, each once, and of the unfolded diagonals that stay within their two triangles."""
    tips = faces.T.ravel()
    table = edge_table(faces[:, [1, 2, 0]].T.ravel(), faces[:, [2, 0, 1]].T.ravel(), len(vertices))
    edges, order = table.edges, table.half_edges
    lengths = np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1)
    inner = table.counts == 2
    first = table.starts[:-1][inner]
    ends, base = edges[inner], lengths[inner]
    tip = tips[order[first]], tips[order[first + 1]]
    place = [_in_plane(vertices, ends, base, corner) for corner in tip]
    across = place[0][1] + place[1][1]
    # where the diagonal crosses the line of the edge
    crossing = (place[0][0] * place[1][1] + place[1][0] * place[0][1]) / np.maximum(across, np.finfo(float).tiny)
    within = (crossing > 0.0) & (crossing < base) & (tip[0] != tip[1])
    diagonals = np.hypot(place[0][0] - place[1][0], across)
    tails = np.concatenate([edges[:, 0], tip[0][within]])
    heads = np.concatenate([edges[:, 1], tip[1][within]])
    # sparse graphs sum what is given twice: of two links of the same ends the shorter one counts
    links, owner, _, _ = edge_table(tails, heads, len(vertices))
    shortest = np.full(len(links), np.inf)
    np.minimum.at(shortest, owner, np.concatenate([lengths, diagonals[within]]))
    return links[:, 0], links[:, 1], shortest


def _in_plane(vertices: Floats, ends: Integers, base: Floats, corner: Integers) -> tuple[Floats, Floats]:
    """Distance of a corner from the first end along the edge, and its height over it."""
    side = vertices[corner] - vertices[ends[:, 0]]
    direction = (vertices[ends[:, 1]] - vertices[ends[:, 0]]) / base[:, None]
    along = (side * direction).sum(axis=1)
    return along, np.sqrt(np.maximum((side**2).sum(axis=1) - along**2, 0.0))
