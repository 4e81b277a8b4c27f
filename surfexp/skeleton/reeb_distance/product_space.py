"""The space on which two matched contractions show their distance: products of what was drawn together, and walks along chains."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise, product
from typing import NamedTuple

import numpy as np

from surfexp.skeleton.common_space import CommonSpace
from surfexp.skeleton.reeb_distance.common_walk import Place, common_walk
from surfexp.skeleton.reeb_distance.contraction import Chain, Contraction
from surfexp.skeleton.reeb_distance.height_graph import merged_nodes

# a node and None, or an arc and how far along it from the end where a chain enters
Location = tuple[int, float | None]
Point = tuple[Location, Location]


class Part(NamedTuple):
    """Locations in a graph, and which of them are joined by a piece of an arc."""

    locations: list[Location]
    joined: list[tuple[Location, Location]]


class Match(NamedTuple):
    """Two contractions that are the same graph, and the chains that are walked along together within a distance."""

    first: Contraction
    second: Contraction
    chains: list[tuple[Chain, Chain]]
    distance: float


def common_space(match: Match) -> CommonSpace:
    """Build the common space of two graphs inside their product.

    Parameters
    ----------
    match : Match

    Returns
    -------
    CommonSpace
    """
    one, other = _Located(match.first), _Located(match.second)
    arcs: dict[frozenset[Point], None] = {}
    triangles: dict[frozenset[Point], None] = {}
    points: dict[Point, int] = {}

    def join(*corners: Point) -> None:
        for corner in corners:
            points.setdefault(corner, len(points))
        if len(set(corners)) == len(corners) > 1:
            (arcs if len(corners) == 2 else triangles)[frozenset(corners)] = None

    def fill(ours: Part, theirs: Part) -> None:
        for point in product(ours.locations, theirs.locations):
            join(point)
        for a, (s, t) in product(ours.locations, theirs.joined):
            join((a, s), (a, t))
        for (a, b), s in product(ours.joined, theirs.locations):
            join((a, s), (b, s))
        for (a, b), (s, t) in product(ours.joined, theirs.joined):
            join((a, s), (b, t))
            join((a, s), (b, s), (b, t))
            join((a, s), (a, t), (b, t))

    if not match.chains:
        fill(one.piece(0), other.piece(0))
    for ours, theirs in match.chains:
        walk = common_walk(ours, theirs, match.distance)
        for place, there in walk:
            fill(one.standing(ours, place), other.standing(theirs, there))
        for (place, there), (onward, beyond) in pairwise(walk):
            if place == onward:
                fill(one.standing(ours, place), _path(other.moving(theirs, there, beyond)))
            elif there == beyond:
                fill(_path(one.moving(ours, place, onward)), other.standing(theirs, there))
            else:
                ways = one.moving(ours, place, onward), other.moving(theirs, there, beyond)
                for begin, end in pairwise(zip(*ways, strict=True)):
                    join(begin, end)
    return CommonSpace(
        np.array([one.heights[a] for a, _ in points]),
        np.array([other.heights[s] for _, s in points]),
        np.array([sorted(points[end] for end in arc) for arc in arcs], dtype=np.int64).reshape(-1, 2),
        np.array([sorted(points[end] for end in face) for face in triangles], dtype=np.int64).reshape(-1, 3),
    )


def _path(way: list[Location]) -> Part:
    return Part(way, list(pairwise(way)))


class _Located:
    """The locations in a graph that a common space lies above, with their heights.

    Arcs that are drawn together and join the same pair have a middle, as has every way along a chain, so that no two arcs of
    the space join the same pair.
    """

    def __init__(self, contraction: Contraction) -> None:
        graph = self._graph = contraction.graph
        self.heights: dict[Location, float] = {(node, None): height for node, height in enumerate(graph.heights)}
        self._root = merged_nodes(len(graph.heights), [graph.arcs[at] for at in contraction.gone])
        self._pieces: dict[int, Part] = {root: Part([], []) for root in set(self._root)}
        for node, root in enumerate(self._root):
            self._pieces[root].locations.append((node, None))
        often = Counter(graph.arcs)
        for at in sorted(contraction.gone):
            a, b = graph.arcs[at]
            ends: list[Location] = [(a, None), (b, None)]
            if often[a, b] > 1:
                ends.insert(1, self._along(at, 0, 0.5))
            piece = self._pieces[self._root[a]]
            piece.locations.extend(ends[1:-1])
            piece.joined.extend(pairwise(ends))

    def piece(self, node: int) -> Part:
        """What was drawn together with a node."""
        return self._pieces[self._root[node]]

    def standing(self, chain: Chain, place: Place) -> Part:
        """All that lies at a place of a chain."""
        step, share = place
        if share is not None:
            return Part([self._on(chain, step, share)], [])
        at, side = chain.steps[min(step, len(chain.steps) - 1)]
        return self.piece(self._graph.arcs[at][side if step < len(chain.steps) else 1 - side])

    def moving(self, chain: Chain, place: Place, onward: Place) -> list[Location]:
        """Where a way along one arc of a chain begins, its middle and its end."""
        step, begin = place[0], place[1] or 0.0
        end = 1.0 if onward[1] is None else onward[1]
        return [self._on(chain, step, share) for share in (begin, (begin + end) / 2, end)]

    def _on(self, chain: Chain, step: int, share: float) -> Location:
        return self._along(*chain.steps[step], share)

    def _along(self, at: int, side: int, share: float) -> Location:
        ends = self._graph.arcs[at]
        if share in (0.0, 1.0):
            return ends[side if share == 0.0 else 1 - side], None
        begin, end = self._graph.heights[ends[side]], self._graph.heights[ends[1 - side]]
        # rounding may not lead beyond the end, where the height would turn over
        self.heights[at, share] = float(np.clip(begin + share * (end - begin), min(begin, end), max(begin, end)))
        return at, share
