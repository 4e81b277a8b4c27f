"""Which contractions of a graph are tried: first the orders that always take the narrowest chain."""

from __future__ import annotations

from collections import deque

from surfexp.skeleton.reeb_distance.contraction import Contraction, contracted
from surfexp.skeleton.reeb_distance.height_graph import HeightGraph


class Contractions:
    """The contractions of a graph that draw whole chains together one after the other.

    Parameters
    ----------
    graph : HeightGraph
    most : int
        How many are tried, with the orders that always take the narrowest.
    """

    def __init__(self, graph: HeightGraph, most: int) -> None:
        self._graph, self._most = graph, most
        self._known: dict[frozenset[int], Contraction] = {}
        self._orders = self._narrowest(True) + self._narrowest(False)

    def up_to(self, width: float) -> tuple[list[Contraction], bool]:
        """Return those that are no wider: first the orders that always take the narrowest.

        Parameters
        ----------
        width : float

        Returns
        -------
        list of Contraction
        bool
            Whether these are all.
        """
        waiting = deque(self._orders)
        tried: dict[frozenset[int], Contraction] = {}
        while waiting and len(tried) < self._most:
            gone = waiting.popleft()
            if gone not in tried:
                tried[gone] = self._of(gone)
                if tried[gone].width <= width:
                    waiting.extend(gone | chain.arcs for chain in tried[gone].chains)
        return [one for one in tried.values() if one.width <= width], not waiting

    def to_a_point(self) -> Contraction:
        """Return the one that draws all arcs together."""
        return self._of(frozenset(range(len(self._graph.arcs))))

    def _narrowest(self, features: bool) -> list[frozenset[int]]:
        """Return the contractions of always the narrowest chain, or branch or side of a loop, the last first."""
        order = [frozenset[int]()]
        while chains := [
            one for one in self._of(order[-1]).chains if not features or self._of(order[-1]).is_feature(one)
        ]:
            order.append(order[-1] | min(chains, key=lambda chain: chain.width).arcs)
        return order[::-1]

    def _of(self, gone: frozenset[int]) -> Contraction:
        if gone not in self._known:
            self._known[gone] = contracted(self._graph, gone)
        return self._known[gone]
