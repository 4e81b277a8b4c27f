"""Simplification of a Reeb graph by persistence, and its contraction to sampled levels."""

from __future__ import annotations

from heapq import heappop, heappush

import numpy as np

from surfexp.contract.arrays import Integers
from surfexp.skeleton.exact_reeb_graph import ReebGraph

Neighbours = list[list[list[int]]]


def simplified(graph: ReebGraph, threshold: float) -> ReebGraph:
    """Cut off the branches that are shorter than a threshold, shortest first, and join what passes through.

    A branch runs from an extremum to a fork with another branch on the same side; its length is the persistence of the
    extremum. Loops are never cut: b1 stays.

    Parameters
    ----------
    graph : ReebGraph
    threshold : float
        In the unit of the feature; at 0 nothing is cut.

    Returns
    -------
    ReebGraph
        `vertex_arcs` of a vertex on a branch that was cut is -1.

    Raises
    ------
    ValueError
        If the threshold is negative or not a number.
    """
    if not threshold >= 0.0:
        raise ValueError(f"persistence threshold is {threshold}, it must be at least 0")
    values = graph.values
    ends: list[list[int] | None] = [list(arc) for arc in graph.arcs.tolist()]
    # arcs below and above each node
    around: Neighbours = [[[], []] for _ in values]
    for arc, (lower, upper) in enumerate(graph.arcs.tolist()):
        around[lower][1].append(arc)
        around[upper][0].append(arc)
    merged = np.arange(len(ends))
    heap: list[tuple[float, int]] = []

    def offer(arc: int) -> None:
        lower, upper = ends[arc] or (0, 0)
        if _is_branch(around, lower, upper):
            heappush(heap, (float(values[upper] - values[lower]), arc))

    for arc in range(len(ends)):
        offer(arc)
    while heap:
        length, arc = heappop(heap)
        pair = ends[arc]
        if length >= threshold:
            break
        if pair is None or length != values[pair[1]] - values[pair[0]] or not _is_branch(around, *pair):
            continue
        lower, upper = pair
        around[lower][1].remove(arc)
        around[upper][0].remove(arc)
        ends[arc], merged[arc] = None, -1
        fork = upper if not around[lower][0] and not around[lower][1] else lower
        below, above = around[fork]
        if len(below) == 1 and len(above) == 1:
            kept, gone = below[0], above[0]
            kept_ends, gone_ends = ends[kept], ends[gone]
            assert kept_ends is not None and gone_ends is not None  # noqa: S101, narrows a type
            kept_ends[1] = gone_ends[1]
            around[gone_ends[1]][0][around[gone_ends[1]][0].index(gone)] = kept
            around[fork], ends[gone], merged[gone] = [[], []], None, kept
            offer(kept)
        else:
            for other in (*below, *above):
                offer(other)
    return _collected(graph, ends, around, merged)


def _is_branch(around: Neighbours, lower: int, upper: int) -> bool:
    from_minimum = not around[lower][0] and len(around[lower][1]) == 1 and len(around[upper][0]) > 1
    from_maximum = not around[upper][1] and len(around[upper][0]) == 1 and len(around[lower][1]) > 1
    return from_minimum or from_maximum


def _collected(graph: ReebGraph, ends: list[list[int] | None], around: Neighbours, merged: Integers) -> ReebGraph:
    for arc in range(len(merged)):
        root = arc
        while root >= 0 and merged[root] != root:
            root = int(merged[root])
        merged[arc] = root
    kept_nodes = np.array([bool(below or above) for below, above in around], dtype=bool)
    kept_arcs = np.array([pair is not None for pair in ends], dtype=bool)
    node_number, arc_number = np.cumsum(kept_nodes) - 1, np.cumsum(kept_arcs) - 1
    arcs = np.array([pair for pair in ends if pair is not None], dtype=np.int64).reshape(-1, 2)
    final = np.where(merged >= 0, arc_number[np.maximum(merged, 0)], -1)
    vertex_arcs = np.where(graph.vertex_arcs >= 0, final[np.maximum(graph.vertex_arcs, 0)], -1)
    return ReebGraph(graph.vertices[kept_nodes], graph.values[kept_nodes], node_number[arcs], vertex_arcs)
