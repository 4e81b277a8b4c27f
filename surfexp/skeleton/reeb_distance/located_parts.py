"""Where in a graph a common space lies above: nodes, places on arcs, and what was drawn together."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from surfexp.skeleton.reeb_distance.common_walk import Place
from surfexp.skeleton.reeb_distance.contraction import Chain, Contraction
from surfexp.skeleton.reeb_distance.height_graph import merged_nodes

# a node and None, or an arc and how far along it from the end where a chain enters
Location = tuple[int, float | None]


class Part(NamedTuple):
    """Locations in a graph, and which of them are joined by a piece of an arc."""

    locations: list[Location]
    joined: list[tuple[Location, Location]]


class Located:
    """The locations in a graph that a common space lies above, with their heights.

    Arcs that are drawn together and join the same pair have a middle, as has every move along a chain, so that no two arcs of
    the space join the same pair.

    Parameters
    ----------
    contraction : Contraction
    """

    def __init__(self, contraction: Contraction) -> None:
        graph = self.graph = contraction.graph
        self.heights: dict[Location, float] = {(node, None): height for node, height in enumerate(graph.heights)}
        self._roots = merged_nodes(len(graph.heights), [graph.arcs[at] for at in contraction.gone])
        self._pieces: dict[int, Part] = {root: Part([], []) for root in set(self._roots)}
        for node in range(len(graph.heights)):
            self.piece(node).locations.append((node, None))
        often = Counter(graph.arcs)
        for at in sorted(contraction.gone):
            a, b = graph.arcs[at]
            ends: list[Location] = [(a, None), (b, None)]
            if often[a, b] > 1:
                ends.insert(1, self.along(at, 0, 0.5))
            self.piece(a).locations.extend(ends[1:-1])
            self.piece(a).joined.extend(pairwise(ends))

    def root(self, node: int) -> int:
        """The node that stands for all that a node was drawn together with."""
        return self._roots[node]

    def piece(self, node: int) -> Part:
        """What was drawn together with a node."""
        return self._pieces[self._roots[node]]

    def way(self, chain: Chain) -> Way:
        """The way along a chain."""
        return Way(self, chain)

    def along(self, at: int, side: int, share: float) -> Location:
        """Where one is on an arc that was entered at a side."""
        ends = self.graph.arcs[at]
        if share in (0.0, 1.0):
            return ends[side if share == 0.0 else 1 - side], None
        begin, end = self.graph.heights[ends[side]], self.graph.heights[ends[1 - side]]
        # rounding may not lead beyond the end, where the height would turn over
        self.heights[at, share] = float(np.clip(begin + share * (end - begin), min(begin, end), max(begin, end)))
        return at, share


class Way:
    """The way along a chain in a graph.

    Parameters
    ----------
    located : Located
    chain : Chain
    """

    def __init__(self, located: Located, chain: Chain) -> None:
        self._located, self._steps = located, chain.steps

    def leaving(self, step: int) -> Location:
        """The node at which an arc of the chain is entered."""
        return self._located.along(*self._steps[step], 0.0)

    def passes(self, place: Place) -> bool:
        """Whether a place is a point of the chain, and not its last."""
        return place[1] is None and place[0] < len(self._steps)

    def passed(self, place: Place) -> Part:
        """What was drawn together to a point of the chain."""
        return self._located.piece(self.leaving(place[0])[0])

    def moved(self, here: Location, place: Place, onward: Place) -> list[Location]:
        """Where a move along one arc begins, its middle and its end; all the same where one stands."""
        if place == onward:
            return [here] * 3
        begin, end = place[1] or 0.0, 1.0 if onward[1] is None else onward[1]
        return [self._located.along(*self._steps[place[0]], share) for share in (begin, (begin + end) / 2, end)]
