"""A connected graph with a height at each node, without the nodes that a Reeb graph has not."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.skeleton.skeleton import arc_components

# ten seconds, and no deeper than Python recurses
MOST_ARCS = 300


@dataclass(frozen=True)
class HeightGraph:
    """Nodes and arcs of a function that is linear and not constant on every arc.

    Parameters
    ----------
    heights : tuple of float
    arcs : tuple of (int, int)
        Lower node before upper; two arcs may join the same pair.
    """

    heights: tuple[float, ...]
    arcs: tuple[tuple[int, int], ...]


def height_graph(heights: Floats, arcs: Integers) -> HeightGraph:
    """Identify the ends of arcs of constant height and leave out the nodes that an arc passes through.

    Parameters
    ----------
    heights : (n,) float64
    arcs : (m, 2) int64
        In either order.

    Returns
    -------
    HeightGraph

    Raises
    ------
    ValueError
        If the graph is empty or has several pieces, a height is not finite, an arc names a node that is not there, or
        more than 300 arcs are left.
    """
    heights = np.asarray(heights, dtype=np.float64)
    arcs = np.asarray(arcs, dtype=np.int64).reshape(-1, 2)
    if not len(heights) or not np.isfinite(heights).all():
        raise ValueError(f"a Reeb graph of {len(heights)} nodes, at least one is needed and all heights must be finite")
    if arcs.min(initial=0) < 0 or arcs.max(initial=0) >= len(heights):
        raise ValueError(f"arcs name nodes {arcs.min()}..{arcs.max()}, the nodes are 0..{len(heights) - 1}")
    if (pieces := arc_components(arcs, len(heights))) > 1:
        raise ValueError(
            f"the Reeb graph has {pieces} pieces, the distance is one of connected graphs: take one of them"
        )
    merged = merged_nodes(len(heights), arcs[heights[arcs[:, 0]] == heights[arcs[:, 1]]].tolist())
    ends = [
        sorted((merged[a], merged[b]), key=heights.__getitem__) for a, b in arcs.tolist() if heights[a] != heights[b]
    ]
    for node in range(len(heights)):
        below = [at for at, arc in enumerate(ends) if arc[1] == node]
        above = [at for at, arc in enumerate(ends) if arc[0] == node]
        if len(below) == len(above) == 1:
            ends[below[0]][1] = ends[above[0]][1]
            del ends[above[0]]
    kept = sorted({node for arc in ends for node in arc} or {merged[0]})
    number = {node: at for at, node in enumerate(kept)}
    if len(ends) > MOST_ARCS:
        raise ValueError(
            f"the Reeb graph has {len(ends)} arcs, the search takes {MOST_ARCS}: cut short branches by `persistence` of reeb_graph"
        )
    return HeightGraph(tuple(heights[kept].tolist()), tuple((number[a], number[b]) for a, b in ends))


def with_tails(graph: HeightGraph) -> HeightGraph:
    """Give each minimum and maximum at which several arcs end an arc of constant height: another space of the same Reeb graph.

    Parameters
    ----------
    graph : HeightGraph

    Returns
    -------
    HeightGraph
        Its new arcs are constant, so that it is no Reeb graph any more.
    """
    sides = [[arc[side] for arc in graph.arcs] for side in (0, 1)]
    ends = [node for node in range(len(graph.heights)) if min(side.count(node) for side in sides) == 0]
    blunt = [node for node in ends if max(side.count(node) for side in sides) > 1]
    tails = tuple((node, len(graph.heights) + at) for at, node in enumerate(blunt))
    return HeightGraph(graph.heights + tuple(graph.heights[node] for node in blunt), graph.arcs + tails)


def merged_nodes(count: int, pairs: list[list[int]] | list[tuple[int, int]]) -> list[int]:
    """Return for each node the least one that pairs connect it with."""
    root = list(range(count))

    def least(node: int) -> int:
        while root[node] != node:
            root[node] = root[root[node]]
            node = root[node]
        return node

    for a, b in pairs:
        first, second = sorted((least(a), least(b)))
        root[second] = first
    return [least(node) for node in range(count)]
