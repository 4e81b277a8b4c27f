"""A space of which two graphs are Reeb graphs: what proves that they are no farther apart than its two functions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.contract.summary import Summarized, Summary
from surfexp.skeleton.complex_reeb_graph import LevelGraph, complex_reeb_graph
from surfexp.skeleton.skeleton import arc_components

# of the largest height: what rounding may add to the difference
ROUNDING = 2e-12


@dataclass(frozen=True, eq=False, repr=False)
class CommonSpace(Summarized):
    """Nodes, arcs and triangles with two functions that are linear on each of them.

    Parameters
    ----------
    first, second : (n,) float64
        The height in either graph at each node.
    arcs : (m, 2) int64
        No two join the same pair; the sides of triangles are among them.
    triangles : (t, 3) int64
        None where a graph is enough.
    """

    first: Floats
    second: Floats
    arcs: Integers
    triangles: Integers

    @property
    def difference(self) -> float:
        """How far the functions are apart."""
        return float(np.abs(self.first - self.second).max())

    def _summary(self) -> Summary:
        sizes = {"nodes": len(self.first), "arcs": len(self.arcs), "triangles": len(self.triangles)}
        return Summary("common space of Reeb graphs", {**sizes, "functions differ by": self.difference})


def common_space_defects(
    space: CommonSpace, first: tuple[Floats, Integers], second: tuple[Floats, Integers], distance: float
) -> tuple[str, ...]:
    """Say what keeps a space from proving that two graphs are within a distance, from these alone.

    Parameters
    ----------
    space : CommonSpace
    first, second : ((n,) float64, (m, 2) int64)
        Heights of the nodes, and arcs.
    distance : float

    Returns
    -------
    tuple of str
        Nothing where it is proved.
    """
    count = len(space.first)
    pairs = np.sort(space.arcs, axis=1)
    if len(np.unique(pairs, axis=0)) < len(pairs) or (pairs[:, 0] == pairs[:, 1]).any():
        return ("two of its arcs join the same pair, or one a node with itself",)
    defects = []
    if (pieces := arc_components(space.arcs, count)) != 1:
        defects.append(f"it has {pieces} pieces, a space of connected graphs has one")
    largest = max(float(np.abs(values).max(initial=0.0)) for values in (space.first, space.second))
    if not space.difference <= distance + ROUNDING * largest:
        defects.append(f"its functions differ by {space.difference:.6g}, more than {distance:.6g}")
    for name, values, (heights, arcs) in (("first", space.first, first), ("second", space.second, second)):
        try:
            shown = complex_reeb_graph(values, space.arcs, space.triangles)
        except ValueError as error:
            return (*defects, str(error))
        given = complex_reeb_graph(heights, arcs, np.zeros((0, 3), dtype=np.int64))
        if not isomorphic(shown, given):
            defects.append(f"its Reeb graph by the {name} function is not the {name} graph")
    return tuple(defects)


def isomorphic(one: LevelGraph, other: LevelGraph) -> bool:
    """Whether two graphs are the same, heights included.

    Parameters
    ----------
    one, other : LevelGraph

    Returns
    -------
    bool
    """
    import networkx

    graphs = []
    for heights, arcs in (one, other):
        graph = networkx.MultiGraph()
        graph.add_nodes_from((node, {"height": height}) for node, height in enumerate(heights.tolist()))
        graph.add_edges_from(arcs.tolist())
        graphs.append(graph)
    return bool(networkx.is_isomorphic(*graphs, node_match=lambda a, b: a["height"] == b["height"]))
