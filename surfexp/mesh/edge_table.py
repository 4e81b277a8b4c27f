"""Edges by counting sort: every pass is linear, none compares rows."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from surfexp.contract.arrays import Integers


class EdgeTable(NamedTuple):
    """Edges and the half-edges on them.

    Parameters
    ----------
    edges : (e, 2) int64
        Smaller vertex first, sorted.
    edge_of : (h,) int64
        Edge of each half-edge.
    half_edges : (h,) int64
        Half-edges by edge, those of one edge by number.
    starts : (e + 1,) int64
        The half-edges of edge i are half_edges[starts[i]:starts[i + 1]].
    """

    edges: Integers
    edge_of: Integers
    half_edges: Integers
    starts: Integers

    @property
    def counts(self) -> Integers:
        """(e,) number of half-edges on each edge."""
        return np.diff(self.starts)


def edge_table(tails: Integers, heads: Integers, vertex_count: int) -> EdgeTable:
    """Return the edges on which half-edges lie.

    Parameters
    ----------
    tails, heads : (h,) int64
        Ends of each half-edge, in 0..vertex_count - 1; both may be one vertex.
    vertex_count : int
    """
    return EdgeTable(*_edge_table(np.minimum(tails, heads), np.maximum(tails, heads), vertex_count))


def half_edge_table(faces: Integers, vertex_count: int) -> EdgeTable:
    """Return the edges of faces (m, 3); half-edge 3 f + k runs from corner k of face f to its corner k + 1."""
    return edge_table(faces.ravel(), faces[:, [1, 2, 0]].ravel(), vertex_count)


@njit(cache=True, nogil=True)
def _edge_table(low: Integers, high: Integers, vertex_count: int) -> tuple[Integers, Integers, Integers, Integers]:
    count = len(low)
    half_edges = _sorted_by(low, _sorted_by(high, np.arange(count), vertex_count), vertex_count)
    edges, edge_of = np.empty((count, 2), np.int64), np.empty(count, np.int64)
    starts, found = np.empty(count + 1, np.int64), 0
    for i, h in enumerate(half_edges):
        if found == 0 or low[h] != edges[found - 1, 0] or high[h] != edges[found - 1, 1]:
            edges[found, 0], edges[found, 1], starts[found] = low[h], high[h], i
            found += 1
        edge_of[h] = found - 1
    starts[found] = count
    return edges[:found].copy(), edge_of, half_edges, starts[: found + 1].copy()


@njit(cache=True, nogil=True)
def _sorted_by(keys: Integers, order: Integers, key_count: int) -> Integers:
    """The order with its items sorted by their keys, those of one key as they were."""
    place = np.zeros(key_count + 1, np.int64)
    for key in keys:
        place[key + 1] += 1
    place = np.cumsum(place)
    result = np.empty_like(order)
    for item in order:
        result[place[keys[item]]] = item
        place[keys[item]] += 1
    return result
