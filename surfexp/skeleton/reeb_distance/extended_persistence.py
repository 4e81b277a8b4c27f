"""Extended persistence and merge trees of a graph with heights."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.skeleton.reeb_distance.height_graph import HeightGraph


@dataclass(frozen=True, eq=False)
class MergeTree:
    """The minima of a graph and the heights at which they come together.

    Parameters
    ----------
    merges : (k, k) float64
        The least height below which two minima are connected; on the diagonal their own heights.
    diagram : (p, 2) float64
        Birth and death of each minimum but the lowest, by the elder rule; ordinary persistence in dimension 0.
    """

    merges: Floats
    diagram: Floats


def merge_tree(graph: HeightGraph) -> MergeTree:
    """Let the part of a graph below a height grow.

    Parameters
    ----------
    graph : HeightGraph

    Returns
    -------
    MergeTree
    """
    heights = graph.heights
    below: list[list[int]] = [[] for _ in heights]
    for lower, upper in graph.arcs:
        below[upper].append(lower)
    minima = [node for node, lower in enumerate(below) if not lower]
    place = {node: at for at, node in enumerate(minima)}
    merges = np.diag([heights[node] for node in minima])
    piece: dict[int, set[int]] = {}
    pairs: list[tuple[float, float]] = []
    for node in sorted(range(len(heights)), key=heights.__getitem__):
        joined = {node}
        births = []
        for part in {id(piece[lower]): piece[lower] for lower in below[node]}.values():
            ours = [place[one] for one in joined if one in place]
            theirs = [place[one] for one in part if one in place]
            merges[np.ix_(ours, theirs)] = merges[np.ix_(theirs, ours)] = heights[node]
            births.append(min(merges[at, at] for at in theirs))
            joined |= part
        pairs += [(birth, heights[node]) for birth in sorted(births)[1:]]
        piece |= dict.fromkeys(joined, joined)
    return MergeTree(merges, np.array(pairs).reshape(-1, 2))


def loop_diagram(graph: HeightGraph) -> Floats:
    """Extended persistence in dimension 1: the height where a loop is born from below, and from above.

    Parameters
    ----------
    graph : HeightGraph

    Returns
    -------
    (b1, 2) float64
        Highest and lowest height of each loop.
    """
    heights = graph.heights
    rising = sorted(graph.arcs, key=lambda arc: heights[arc[1]])
    falling = sorted(range(len(rising)), key=lambda at: -heights[rising[at][0]])
    # sums of arcs modulo 2 as bits: from each node to the root of its tree in the part above
    root, path = list(range(len(heights))), [0] * len(heights)
    loops: dict[int, int] = {}
    pairs: list[tuple[float, float]] = []
    for at in falling:
        a, b = rising[at]
        between = path[a] ^ path[b] ^ (1 << at)
        if root[a] != root[b]:
            gone, kept = root[a], root[b]
            for node in range(len(root)):
                if root[node] == gone:
                    root[node], path[node] = kept, path[node] ^ between
            continue
        # the arc that closes the loop last from below, after loops that lie higher are added
        while (last := between.bit_length() - 1) in loops:
            between ^= loops[last]
        loops[last] = between
        pairs.append((heights[rising[last][1]], heights[a]))
    return np.array(pairs).reshape(-1, 2)


def turned_over(graph: HeightGraph) -> HeightGraph:
    """Return the graph of the negative heights."""
    return HeightGraph(tuple(-height for height in graph.heights), tuple((b, a) for a, b in graph.arcs))
