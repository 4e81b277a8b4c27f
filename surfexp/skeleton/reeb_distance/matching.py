"""Whether two contractions are the same graph, with heights within a distance: branch and bound over their hubs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from surfexp.skeleton.reeb_distance.bottleneck import has_perfect_matching, perfect_matching
from surfexp.skeleton.reeb_distance.chain_distance import reached, within
from surfexp.skeleton.reeb_distance.contraction import Chain, Contraction


class Budget:
    """Steps that a search may take.

    Parameters
    ----------
    steps : int
    """

    def __init__(self, steps: int) -> None:
        self.left = steps

    def spent(self) -> bool:
        """Take one step; whether there was none."""
        self.left -= 1
        return self.left < 0


def matched(
    first: Contraction, second: Contraction, distance: float, budget: Budget
) -> list[tuple[Chain, Chain]] | None:
    """Give each hub of one contraction one of the other, so that the chains between them can be walked along together.

    Parameters
    ----------
    first, second : Contraction
    distance : float
    budget : Budget
        One step is taken for each pair of hubs that is tried.

    Returns
    -------
    list of (Chain, Chain), or None
        The chains that are walked along together: none where both are single points. None also where the budget was spent.
    """
    if first.signature != second.signature or not first.hubs:
        return None
    image: dict[int, int] = {}
    order = _outward(first)

    def fits(hub: int, other: int) -> bool:
        if other in image.values() or first.hubs[hub] != second.hubs[other]:
            return False
        if not within(first.spans[hub], second.spans[other], distance):
            return False
        pairs = {**image, hub: other}.items()
        return all(_parallel(first, second, (hub, at), (other, there), distance) for at, there in pairs)

    def extended() -> bool:
        if len(image) == len(order):
            return True
        hub = order[len(image)]
        for other in range(len(order)):
            if budget.spent():
                return False
            if fits(hub, other):
                image[hub] = other
                if extended():
                    return True
                del image[hub]
        return False

    if not extended():
        return None
    between = [(a, b) for a, b in first.between if a <= b]
    return [pair for a, b in between for pair in _chain_pairs(first, second, (a, b), (image[a], image[b]), distance)]


def _outward(contraction: Contraction) -> list[int]:
    """Return the hubs in an order in which each but the first is joined to an earlier one, the largest degree first."""
    order = [max(range(len(contraction.hubs)), key=contraction.hubs.__getitem__)] if contraction.hubs else []
    for hub in order:
        order += [there for here, there in contraction.between if here == hub and there not in order]
    return order


def _parallel(
    first: Contraction, second: Contraction, pair: tuple[int, int], other: tuple[int, int], distance: float
) -> bool:
    """Whether the chains between two hubs can be paired."""
    ours, theirs = first.between.get(pair, []), second.between.get(other, [])
    return len(ours) == len(theirs) and has_perfect_matching(_allowed(ours, theirs, pair[0] == pair[1], distance))


def _allowed(ours: list[Chain], theirs: list[Chain], turned: bool, distance: float) -> NDArray[np.bool_]:
    """Which chains can be walked along together, a loop in either direction."""
    return np.array(
        [
            [
                reached(one, that, distance).last_ends or (turned and reached(one, that.reversed(), distance).last_ends)
                for that in theirs
            ]
            for one in ours
        ],
        dtype=bool,
    )


def _chain_pairs(
    first: Contraction, second: Contraction, pair: tuple[int, int], other: tuple[int, int], distance: float
) -> list[tuple[Chain, Chain]]:
    """Return the chains between two hubs in pairs, each in the direction in which it is walked along."""
    ours, theirs = first.between[pair], second.between[other]
    columns = perfect_matching(_allowed(ours, theirs, pair[0] == pair[1], distance))
    chosen = [theirs[column] for column in columns]
    return [
        (one, that if reached(one, that, distance).last_ends else that.reversed())
        for one, that in zip(ours, chosen, strict=True)
    ]
