"""The vertices of a mesh with their areas and their neighbours, as compiled loops read them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.triangle_mesh import TriangleMesh


@dataclass(frozen=True, eq=False)
class VertexGraph:
    """Vertices that are joined by edges.

    Parameters
    ----------
    starts : (n + 1,) int64
        Where the neighbours of each vertex begin.
    neighbours : (2 e,) int64
    areas : (n,) float64
        Area of each vertex, in the squared unit of the mesh.
    """

    starts: Integers
    neighbours: Integers
    areas: Floats


def vertex_graph(mesh: TriangleMesh) -> VertexGraph:
    """Return the graph of the edges of a mesh; a vertex has a third of the area of the faces around it.

    Parameters
    ----------
    mesh : TriangleMesh

    Returns
    -------
    VertexGraph
    """
    return graph_of_edges(mesh.edges, mesh.vertex_areas)


def graph_of_edges(edges: Integers, areas: Floats) -> VertexGraph:
    """Return the graph of undirected edges.

    Parameters
    ----------
    edges : (e, 2) int64
        Each once.
    areas : (n,) float64

    Returns
    -------
    VertexGraph
    """
    both = np.concatenate([edges, edges[:, ::-1]])
    both = both[np.lexsort((both[:, 1], both[:, 0]))]
    starts = np.searchsorted(both[:, 0], np.arange(len(areas) + 1))
    return VertexGraph(starts, np.ascontiguousarray(both[:, 1]), np.ascontiguousarray(areas, dtype=np.float64))
