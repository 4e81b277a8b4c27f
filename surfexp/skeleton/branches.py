"""The Reeb graph with its contours drawn together: arcs from fork to end, each with its polyline and widths."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from surfexp.contract.arrays import Integers
from surfexp.skeleton.polyline import polyline_length
from surfexp.skeleton.skeleton import KINDS, Skeleton

if TYPE_CHECKING:
    import networkx


def branch_paths(skeleton: Skeleton) -> list[Integers]:
    """Nodes along every arc between ends and forks, ends included; a ring without any starts and ends at its lowest node."""
    around: list[list[int]] = [[] for _ in skeleton.positions]
    for a, b in skeleton.arcs.tolist():
        around[a].append(b)
        around[b].append(a)
    done: set[tuple[int, int]] = set()
    paths = []
    forks = [node for node, others in enumerate(around) if len(others) != 2]
    # rings come last, from whatever is left
    for first in [*forks, *np.argsort(skeleton.values, kind="stable").tolist()]:
        for second in around[first]:
            if (first, second) in done:
                continue
            path = [first, second]
            while len(around[path[-1]]) == 2 and path[-1] != first:
                before, after = around[path[-1]]
                path.append(after if before == path[-2] else before)
            done |= {*pairwise(path), *pairwise(path[::-1])}
            paths.append(np.array(path, dtype=np.int64))
    return paths


def branch_graph(skeleton: Skeleton) -> networkx.MultiGraph:
    """The graph of ends and forks alone, in networkx's form.

    Returns
    -------
    networkx.MultiGraph
        Nodes carry `position` (3,), `value` and `kind`; arcs `polyline` (k, 3) from the node of smaller number to the
        other, `values` (k,), `widths` (k,), the lengths of the contours along it, and `length`.
    """
    import networkx

    graph = networkx.MultiGraph(name=skeleton.name, method=skeleton.method)
    paths = branch_paths(skeleton)
    nodes = {int(node) for path in paths for node in (path[0], path[-1])} | set(np.flatnonzero(skeleton.degrees == 0))
    for node in sorted(nodes):
        kind = KINDS[skeleton.kinds[node]]
        graph.add_node(int(node), position=skeleton.positions[node], value=float(skeleton.values[node]), kind=kind)
    for path in paths:
        ordered = path if path[0] <= path[-1] else path[::-1]
        line = skeleton.positions[ordered]
        graph.add_edge(
            int(ordered[0]),
            int(ordered[-1]),
            polyline=line,
            values=skeleton.values[ordered],
            widths=skeleton.lengths[ordered],
            length=polyline_length(line),
        )
    return graph
