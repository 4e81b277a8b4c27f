"""Whether two chains can be walked along together: a Frechet distance of heights."""

from __future__ import annotations

from typing import NamedTuple

from surfexp.skeleton.reeb_distance.contraction import Chain, Interval


class Reached(NamedTuple):
    """What can be reached of the free space of two chains (Alt and Godau 1995).

    Parameters
    ----------
    corner : list of list of bool
        Whether both can stand at point i of the first and j of the second.
    along, across : list of list of (float, float), or None
        Part of arc j of the second that is met at point i of the first; part of arc i of the first that is met at point j of
        the second.
    """

    corner: list[list[bool]]
    along: list[list[Interval | None]]
    across: list[list[Interval | None]]

    @property
    def last_ends(self) -> bool:
        """Whether both can go to their last ends, never back."""
        return self.corner[-1][-1]


def within(first: Interval, second: Interval, distance: float) -> bool:
    """Whether all heights of one interval are within a distance of all of another."""
    return first[1] - distance <= second[0] and second[1] - distance <= first[0]


def reached(first: Chain, second: Chain, distance: float) -> Reached:
    """Find what two points can reach from the first ends of their chains, with heights within a distance.

    Where one of them stands at what was drawn together, all heights there count.

    Parameters
    ----------
    first, second : Chain
    distance : float

    Returns
    -------
    Reached
    """
    rows, columns = len(first.points), len(second.points)
    corner = [[False] * columns for _ in range(rows)]
    along: list[list[Interval | None]] = [[None] * columns for _ in range(rows)]
    across: list[list[Interval | None]] = [[None] * columns for _ in range(rows)]
    for i in range(rows):
        for j in range(columns):
            before, below = along[i][j - 1] if j else None, across[i - 1][j] if i else None
            inside = i > 0 and j > 0 and (corner[i - 1][j - 1] or along[i - 1][j - 1] or across[i - 1][j - 1])
            met = i + j == 0 or inside or (before and before[1] == 1.0) or (below and below[1] == 1.0)
            corner[i][j] = bool(met) and within(first.points[i], second.points[j], distance)
            if j + 1 < columns:
                free = _free(first.points[i], second.slopes[j], distance)
                side = i > 0 and (corner[i - 1][j] or across[i - 1][j])
                along[i][j] = _entered(free, corner[i][j], bool(side), along[i - 1][j] if i else None)
            if i + 1 < rows:
                free = _free(second.points[j], first.slopes[i], distance)
                side = j > 0 and (corner[i][j - 1] or along[i][j - 1])
                across[i][j] = _entered(free, corner[i][j], bool(side), across[i][j - 1] if j else None)
    return Reached(corner, along, across)


def _free(point: Interval, slope: Interval, distance: float) -> Interval | None:
    """Return the part of an arc, in 0..1, that is within a distance of a point."""
    low, high = point[1] - distance, point[0] + distance
    start, rise = slope[0], slope[1] - slope[0]
    if rise == 0.0:
        return (0.0, 1.0) if low <= start <= high else None
    first, last = sorted(((low - start) / rise, (high - start) / rise))
    part = (max(0.0, first), min(1.0, last))
    return part if low <= high and part[0] <= part[1] else None


def _entered(free: Interval | None, corner: bool, side: bool, opposite: Interval | None) -> Interval | None:
    """Return what is reached of one side of a cell, from its corner, the adjacent or the opposite side."""
    if free is None:
        return None
    if corner or side:
        return free
    if opposite is not None and max(free[0], opposite[0]) <= free[1]:
        return max(free[0], opposite[0]), free[1]
    return None
