"""The vertex of a sphere that is nearest to where a rotation takes each vertex."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from scipy.sparse import csr_array
from scipy.sparse.csgraph import breadth_first_order
from scipy.spatial import ConvexHull, KDTree, QhullError

from surfexp.contract.arrays import Floats, Integers


@dataclass(frozen=True, eq=False)
class NearestVertices:
    """Finds nearest vertices by steps to nearer neighbours in the hull of the points.

    The convex hull of points on a sphere is their Delaunay triangulation, in which a vertex that is not the nearest
    has a neighbour that is nearer. A vertex starts where a neighbour of it came to, which is a step or two away: a
    search in a tree, which begins at its root for each vertex, takes several times as long. Made by `of`.

    Parameters
    ----------
    directions : (n, 3) float64
        Of length 1.
    starts, neighbours : (n + 1,) and (k,) int64
        Those of vertex i are neighbours[starts[i]:starts[i + 1]].
    order, parents : (n,) int64
        Each vertex of the order but the first comes after its parent, which is a neighbour.

    References
    ----------
    Bose, Morin: Online routing in triangulations (2004), for why steps to nearer neighbours arrive.
    """

    directions: Floats
    starts: Integers
    neighbours: Integers
    order: Integers
    parents: Integers

    @classmethod
    def of(cls, directions: Floats) -> NearestVertices:
        """Triangulate the points and order them so that each but the first follows a neighbour.

        Parameters
        ----------
        directions : (n, 3) float64
            Of length 1.

        Raises
        ------
        ValueError
            If the points lie in a plane.
        """
        try:
            hull = ConvexHull(directions)
        except QhullError as error:
            raise ValueError(f"{len(directions)} vertices lie in a plane: give a sphere") from error
        edges = hull.simplices[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
        # vertices that coincide with another, of which the hull has one
        inside = np.setdiff1d(np.arange(len(directions)), hull.vertices)
        nearest = hull.vertices[KDTree(directions[hull.vertices]).query(directions[inside])[1]]
        edges = np.concatenate([edges, np.stack([inside, nearest], axis=1)])
        both = np.concatenate([edges, edges[:, ::-1]]).T
        graph = csr_array((np.ones(len(both[0])), both), shape=(len(directions), len(directions)))
        graph.sum_duplicates()
        order, parents = breadth_first_order(graph, int(hull.vertices[0]))
        return cls(directions, *(part.astype(np.int64) for part in (graph.indptr, graph.indices, order, parents)))

    def of_rotated(self, rotation: Floats) -> Integers:
        """Return the vertex nearest to the rotated place of each.

        Parameters
        ----------
        rotation : (3, 3) float64

        Returns
        -------
        (n,) int64
        """
        places = self.directions @ rotation.T
        return np.asarray(_walk(self.directions, self.starts, self.neighbours, self.order, self.parents, places))


@njit(cache=True)
def _walk(
    directions: Floats, starts: Integers, neighbours: Integers, order: Integers, parents: Integers, places: Floats
) -> Integers:
    found = np.empty(len(order), dtype=np.int64)
    here = order[0]
    for vertex in order:
        if vertex != order[0]:
            here = found[parents[vertex]]
        least = _square(directions[here], places[vertex])
        arrived = False
        while not arrived:
            arrived, middle = True, here
            for k in range(starts[middle], starts[middle + 1]):
                square = _square(directions[neighbours[k]], places[vertex])
                if square < least:
                    least, here, arrived = square, neighbours[k], False
        found[vertex] = here
    return found


@njit(cache=True)
def _square(first: Floats, second: Floats) -> float:
    return float((first[0] - second[0]) ** 2 + (first[1] - second[1]) ** 2 + (first[2] - second[2]) ** 2)
