"""Clusters of a map beyond a threshold: connected vertices of one sign, with area and mass."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats, Integers
from surfexp.inference.vertex_graph import VertexGraph
from surfexp.mesh.union_find import join, numbered_sets

OUTSIDE = -1


@dataclass(frozen=True, eq=False)
class Clusters:
    """Clusters of a map.

    Parameters
    ----------
    labels : (n,) int64
        Number of the cluster of each vertex, from 0 in the order of their first vertices; -1 outside.
    areas : (c,) float64
        In the squared unit of the mesh.
    masses : (c,) float64
        Sum of |value| times area over the vertices.
    peaks : (c,) int64
        Vertex of the largest |value|; of equals the first.
    """

    labels: Integers
    areas: Floats
    masses: Floats
    peaks: Integers


def clusters_beyond(values: Floats, graph: VertexGraph, threshold: float, *, two_sided: bool = True) -> Clusters:
    """Return the connected sets of vertices of one sign whose value reaches a threshold in modulus.

    Parameters
    ----------
    values : (n,) float64
        NaN is outside.
    graph : VertexGraph
    threshold : float
        Above 0.
    two_sided : bool
        Whether negative values form clusters too.

    Returns
    -------
    Clusters

    Raises
    ------
    ValueError
        If the threshold is not above 0.
    """
    if not threshold > 0.0:
        raise ValueError(f"threshold = {threshold:g}, a number above 0 is needed")
    size = np.abs(values) if two_sided else values
    return _summed(_labels(values, size >= threshold, graph.starts, graph.neighbours), values, graph.areas)


def clusters_where(inside: NDArray[np.bool_], values: Floats, graph: VertexGraph) -> Clusters:
    """Return the connected sets of vertices of one sign among those that are named.

    Parameters
    ----------
    inside : (n,) bool
    values : (n,) float64
    graph : VertexGraph

    Returns
    -------
    Clusters
    """
    return _summed(_labels(values, inside, graph.starts, graph.neighbours), values, graph.areas)


def _summed(labels: Integers, values: Floats, areas: Floats) -> Clusters:
    inside = np.flatnonzero(labels != OUTSIDE)
    own, sizes = labels[inside], np.abs(values[inside])
    by_size = np.lexsort((inside, -sizes, own))
    _, first = np.unique(own[by_size], return_index=True)
    return Clusters(
        labels,
        np.bincount(own, areas[inside]).astype(np.float64),
        np.bincount(own, areas[inside] * sizes).astype(np.float64),
        inside[by_size[first]],
    )


@njit(cache=True, nogil=True)
def _labels(values: Floats, inside: NDArray[np.bool_], starts: Integers, neighbours: Integers) -> Integers:
    n = len(values)
    parents = np.arange(n)
    for v in range(n):
        if inside[v]:
            for at in range(starts[v], starts[v + 1]):
                u = neighbours[at]
                if u < v and inside[u] and (values[u] > 0.0) == (values[v] > 0.0):
                    join(parents, u, v)
    sets = numbered_sets(parents)
    numbers, count = np.full(n, OUTSIDE), 0
    labels = np.full(n, OUTSIDE)
    for v in range(n):
        if inside[v]:
            if numbers[sets[v]] == OUTSIDE:
                numbers[sets[v]] = count
                count += 1
            labels[v] = numbers[sets[v]]
    return labels
