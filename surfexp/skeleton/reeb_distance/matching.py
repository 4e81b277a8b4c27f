"""Whether two contractions are the same graph, with heights within a distance: branch and bound over their hubs."""

from __future__ import annotations

import numpy as np

from surfexp.skeleton.reeb_distance.bottleneck import has_perfect_matching
from surfexp.skeleton.reeb_distance.chain_distance import walked_together, within
from surfexp.skeleton.reeb_distance.contraction import Contraction


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


def matched(first: Contraction, second: Contraction, distance: float, budget: Budget) -> bool:
    """Give each hub of one contraction one of the other, so that the chains between them can be walked along together.

    Parameters
    ----------
    first, second : Contraction
    distance : float
    budget : Budget
        One step is taken for each pair of hubs that is tried.

    Returns
    -------
    bool
        True is proved; false also where the budget was spent.
    """
    if first.signature != second.signature or not first.hubs:
        return False
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

    return extended()


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
    if len(ours) != len(theirs):
        return False
    turned = pair[0] == pair[1]
    return has_perfect_matching(
        np.array(
            [
                [
                    walked_together(one, that, distance) or (turned and walked_together(one, that.reversed(), distance))
                    for that in theirs
                ]
                for one in ours
            ],
            dtype=bool,
        )
    )
