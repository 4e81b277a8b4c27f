"""The graph on which nodal domains are counted: nodes of a finite element mesh and the sides between them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import coo_array, csr_array, tril
from scipy.sparse.csgraph import reverse_cuthill_mckee

from surfexp.contract.arrays import Integers
from surfexp.operators.elements_nodes import ElementNodes

# small triangles of an element, by its local nodes (see `LagrangeElement.nodes`)
PARTS = {
    1: [[0, 1, 2]],
    2: [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]],
    3: [[0, 3, 8], [3, 9, 8], [3, 4, 9], [4, 5, 9], [4, 1, 5], [8, 9, 7], [9, 6, 7], [9, 5, 6], [7, 6, 2]],
}


@dataclass(frozen=True, eq=False)
class NodalGraph:
    """Compressed neighbour lists.

    Parameters
    ----------
    starts : (n + 1,) int32
    neighbours : int32 array
        Neighbours of node i are neighbours[starts[i] : starts[i + 1]].
    """

    starts: Integers
    neighbours: Integers

    @cached_property
    def sweep(self) -> tuple[Integers, Integers, Integers]:
        """The nodes in an order of small bandwidth (Cuthill and McKee), and of each place its neighbours at earlier places.

        (n,) int32 nodes, then (n + 1,) int32 starts and int32 places in the manner of the lists above.
        """
        count = len(self.starts) - 1
        entries = np.ones(len(self.neighbours), np.int8)
        graph = csr_array((entries, self.neighbours, self.starts), shape=(count, count))
        order = reverse_cuthill_mckee(graph, symmetric_mode=True)
        earlier = tril(graph[order][:, order], -1, format="csr")
        return order.astype(np.int32), earlier.indptr.astype(np.int32), earlier.indices.astype(np.int32)


def nodal_graph(faces: Integers, count: int) -> NodalGraph:
    """Return the graph of the sides of triangles over `count` nodes."""
    rows, columns = faces[:, [0, 1, 2]].ravel(), faces[:, [1, 2, 0]].ravel()
    half = coo_array((np.ones(len(rows), np.int8), (rows, columns)), shape=(count, count)).tocsr()
    joined = csr_array(half + half.T)
    joined.sort_indices()
    return NodalGraph(joined.indptr.astype(np.int32), joined.indices.astype(np.int32))


def element_faces(nodes: ElementNodes) -> Integers:
    """Return the triangles into which the nodes of elements of order 2 or 3 cut them, 4 or 9 for each face."""
    return nodes.connectivity[:, PARTS[nodes.order]].reshape(-1, 3)
