"""The space on which two matched contractions show their distance: products of what was drawn together, and walks along chains."""

from __future__ import annotations

from collections import defaultdict
from itertools import pairwise
from typing import NamedTuple

from surfexp.skeleton.common_space import CommonSpace
from surfexp.skeleton.reeb_distance.common_walk import Place, common_walk
from surfexp.skeleton.reeb_distance.contraction import Chain, Contraction
from surfexp.skeleton.reeb_distance.located_parts import Located, Location, Part, Way
from surfexp.skeleton.reeb_distance.product_complex import Point, Product


class Match(NamedTuple):
    """Two contractions that are the same graph, and the chains that are walked along together within a distance."""

    first: Contraction
    second: Contraction
    chains: list[tuple[Chain, Chain]]
    distance: float


def common_space(match: Match) -> CommonSpace:
    """Build the common space of two graphs inside their product.

    What was drawn together meets what it is matched with in one point, where all chains can begin at either of the two through
    that point; else their product is filled with triangles.

    Parameters
    ----------
    match : Match

    Returns
    -------
    CommonSpace
    """
    one, other = Located(match.first), Located(match.second)
    space = Product()
    # where chains begin at the hubs, by the nodes that stand for what was drawn together there
    begun: dict[tuple[int, int], set[Point]] = defaultdict(set)
    if not match.chains:
        begun[one.root(0), other.root(0)] = set()
    for ours, theirs in match.chains:
        for begin in _walked(space, one.way(ours), other.way(theirs), common_walk(ours, theirs, match.distance)):
            begun[one.root(begin[0][0]), other.root(begin[1][0])].add(begin)
    for hub, begins in begun.items():
        parts = one.piece(hub[0]), other.piece(hub[1])
        meeting = _meeting(begins, *parts, one.heights, other.heights)
        if meeting is None:
            space.fill(*parts)
        else:
            space.fill(parts[0], _single(meeting[1]))
            space.fill(_single(meeting[0]), parts[1])
    return space.with_heights(one.heights, other.heights)


def _walked(space: Product, ours: Way, theirs: Way, walk: list[tuple[Place, Place]]) -> tuple[Point, Point]:
    """Add the curve of two chains, with what was drawn together on them where each arrives there, and return its ends."""
    here, there = ours.leaving(0), theirs.leaving(0)
    start = here, there
    for (place, beside), (onward, beyond) in pairwise(walk):
        moves = ours.moved(here, place, onward), theirs.moved(there, beside, beyond)
        for begin, end in pairwise(zip(*moves, strict=True)):
            space.join(begin, end)
        here, there = moves[0][-1], moves[1][-1]
        if onward != place and ours.passes(onward):
            space.fill(ours.passed(onward), _single(there))
            here = ours.leaving(onward[0])
        if beyond != beside and theirs.passes(beyond):
            space.fill(_single(here), theirs.passed(beyond))
            there = theirs.leaving(beyond[0])
    return start, (here, there)


def _meeting(
    begins: set[Point], ours: Part, theirs: Part, f: dict[Location, float], g: dict[Location, float]
) -> Point | None:
    """Return the point at which two parts meet with the least difference of heights, so that all chains begin on them."""

    def apart(height: float, heights: list[float]) -> float:
        return max(abs(height - other) for other in heights)

    low_high = [[pick(h[at] for at in part.locations) for pick in (min, max)] for part, h in ((ours, f), (theirs, g))]
    costs = [
        {at: apart(h[at], low_high[1 - side]) for at in part.locations}
        for side, (part, h) in enumerate(((ours, f), (theirs, g)))
    ]
    points: list[Point] = []
    for a in ours.locations:
        off = {s for r, s in begins if r != a}
        if len(off) < 2:
            points.append((a, min(off or theirs.locations, key=costs[1].__getitem__)))
    return min(points, key=lambda point: max(costs[0][point[0]], costs[1][point[1]]), default=None)


def _single(location: Location) -> Part:
    return Part([location], [])
