"""How two chains are walked along together: the way back through what was reached of their free space."""

from __future__ import annotations

from surfexp.skeleton.reeb_distance.chain_distance import Reached, reached
from surfexp.skeleton.reeb_distance.contraction import Chain

# a point and None, or an arc and how far along it, in 0..1
Place = tuple[int, float | None]


def common_walk(first: Chain, second: Chain, distance: float) -> list[tuple[Place, Place]]:
    """Walk from end to end, never back, with heights within a distance.

    Parameters
    ----------
    first, second : Chain
        They can be walked along together.
    distance : float

    Returns
    -------
    list of (Place, Place)
        Between two of them each stands, or moves along one arc.
    """
    known = reached(first, second, distance)
    start: tuple[Place, Place] = ((0, None), (0, None))
    walk: list[tuple[Place, Place]] = [((len(first.slopes), None), (len(second.slopes), None))]
    while walk[-1] != start:
        walk.append(_before(known, *walk[-1]))
    return walk[::-1]


def _before(known: Reached, one: Place, other: Place) -> tuple[Place, Place]:
    """Return a place from which another is reached in a straight line."""
    corner, along, across = known
    (i, u), (j, v) = one, other
    if u is None and v is None:
        if j and (part := along[i][j - 1]) and part[1] == 1.0:
            return one, (j - 1, part[0])
        if i and (part := across[i - 1][j]) and part[1] == 1.0:
            return (i - 1, part[0]), other
        return _entry(known, i - 1, j - 1, True)
    if corner[i][j]:
        return (i, None), (j, None)
    return _entry(known, i - 1, j, True) if u is None else _entry(known, i, j - 1, False)


def _entry(known: Reached, i: int, j: int, across_first: bool) -> tuple[Place, Place]:
    """Return where a cell is entered: at its corner, at the side next to the goal, or at the opposite one, as early as can be."""
    if known.corner[i][j]:
        return (i, None), (j, None)
    by_along: list[tuple[Place, Place]] = [((i, None), (j, part[0])) for part in [known.along[i][j]] if part]
    by_across: list[tuple[Place, Place]] = [((i, part[0]), (j, None)) for part in [known.across[i][j]] if part]
    return (by_across + by_along if across_first else by_along + by_across)[0]
