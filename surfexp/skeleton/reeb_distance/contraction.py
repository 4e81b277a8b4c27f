"""Contractions of a graph: features drawn together to points, and the chains between those where it branches or ends."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from surfexp.skeleton.reeb_distance.height_graph import HeightGraph, merged_nodes

Interval = tuple[float, float]


@dataclass(frozen=True)
class Chain:
    """A path through points of degree 2, its ends included.

    Parameters
    ----------
    ends : (int, int)
        Positions of its ends among the hubs.
    points : tuple of (float, float)
        Lowest and highest height of what was drawn together to each point.
    slopes : tuple of (float, float)
        Heights at both ends of each arc between them.
    steps : tuple of (int, int)
        These arcs, and the side at which each is entered: 0 from below, 1 from above.
    """

    ends: tuple[int, int]
    points: tuple[Interval, ...]
    slopes: tuple[Interval, ...]
    steps: tuple[tuple[int, int], ...]

    @property
    def arcs(self) -> frozenset[int]:
        """All arcs of the path."""
        return frozenset(at for at, _ in self.steps)

    @property
    def width(self) -> float:
        """The difference of heights that are drawn together if all of it is."""
        return max(high for _, high in self.points) - min(low for low, _ in self.points)

    def reversed(self) -> Chain:
        """Return the same path from its other end."""
        slopes = tuple((b, a) for a, b in self.slopes[::-1])
        steps = tuple((at, 1 - side) for at, side in self.steps[::-1])
        return Chain((self.ends[1], self.ends[0]), self.points[::-1], slopes, steps)


@dataclass(frozen=True, eq=False)
class Contraction:
    """A graph of which some arcs are drawn together.

    Parameters
    ----------
    graph : HeightGraph
    gone : frozenset of int
        The arcs that are drawn together.
    width : float
        The largest difference of heights that are drawn together.
    hubs : tuple of int
        Degrees of the points whose degree is not 2; a circle has none, and no chain.
    spans : tuple of (float, float)
        Lowest and highest height at each hub.
    chains : tuple of Chain
        All paths between hubs.
    """

    graph: HeightGraph
    gone: frozenset[int]
    width: float
    hubs: tuple[int, ...]
    spans: tuple[Interval, ...]
    chains: tuple[Chain, ...]

    @cached_property
    def signature(self) -> tuple[tuple[int, ...], int]:
        """What two contractions share if they are the same graph."""
        return tuple(sorted(self.hubs)), len(self.chains)

    @cached_property
    def between(self) -> dict[tuple[int, int], list[Chain]]:
        """The chains of each pair of hubs, in the direction of the pair."""
        found: dict[tuple[int, int], list[Chain]] = {}
        for chain in self.chains:
            for one in {chain.ends: chain, chain.ends[::-1]: chain.reversed()}.values():
                found.setdefault(one.ends, []).append(one)
        return found

    def is_feature(self, chain: Chain) -> bool:
        """Whether a chain ends at one of its ends, or is one side of a loop."""
        a, b = chain.ends
        return min(self.hubs[a], self.hubs[b]) == 1 or a == b or len(self.between[a, b]) > 1


def contracted(graph: HeightGraph, gone: frozenset[int]) -> Contraction:
    """Draw arcs of a graph together.

    Parameters
    ----------
    graph : HeightGraph
    gone : frozenset of int
        The arcs.

    Returns
    -------
    Contraction
    """
    heights, arcs = graph.heights, graph.arcs
    point = merged_nodes(len(heights), [arcs[at] for at in gone])
    spans: dict[int, Interval] = {}
    for node, height in enumerate(heights):
        low, high = spans.get(point[node], (height, height))
        spans[point[node]] = min(low, height), max(high, height)
    sides: dict[int, list[tuple[int, int]]] = {one: [] for one in spans}
    for at, ends in enumerate(arcs):
        if at not in gone:
            for side in (0, 1):
                sides[point[ends[side]]].append((at, side))
    hubs = [one for one in spans if len(sides[one]) != 2]
    place = {one: at for at, one in enumerate(hubs)}
    chains: list[Chain] = []
    used = set(gone)
    for hub in hubs:
        for at, side in sides[hub]:
            if at in used:
                continue
            one, points, slopes = hub, [spans[hub]], []
            along: list[tuple[int, int]] = []
            while not along or one not in place:
                if along:
                    at, side = next(step for step in sides[one] if step[0] != along[-1][0])
                slopes.append((heights[arcs[at][side]], heights[arcs[at][1 - side]]))
                one = point[arcs[at][1 - side]]
                points.append(spans[one])
                along.append((at, side))
            chains.append(Chain((place[hub], place[one]), tuple(points), tuple(slopes), tuple(along)))
            used |= chains[-1].arcs
    return Contraction(
        graph,
        gone,
        max(high - low for low, high in spans.values()),
        tuple(len(sides[one]) for one in hubs),
        tuple(spans[one] for one in hubs),
        tuple(chains),
    )
