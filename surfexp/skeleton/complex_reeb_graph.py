"""The Reeb graph of a piecewise linear function on arcs and triangles, exactly: no manifold is needed."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from surfexp.contract.arrays import Floats, Integers


class LevelGraph(NamedTuple):
    """Nodes with heights, and arcs from the lower to the upper.

    Parameters
    ----------
    heights : (n,) float64
    arcs : (m, 2) int64
    """

    heights: Floats
    arcs: Integers


def complex_reeb_graph(values: Floats, arcs: Integers, triangles: Integers) -> LevelGraph:
    """Find the components of all level sets at nodes, and of what lies between.

    Parameters
    ----------
    values : (n,) float64
        Linear on arcs and triangles.
    arcs : (m, 2) int64
        Two may join the same pair, where no triangle is there.
    triangles : (t, 3) int64
        Their sides are arcs.

    Returns
    -------
    LevelGraph
        Without the nodes that have one arc below and one above.

    Raises
    ------
    ValueError
        If a side of a triangle is no arc.
    """
    count = len(values)
    levels, rank = np.unique(values, return_inverse=True)
    arcs = np.take_along_axis(arcs, np.argsort(rank[arcs], axis=1, kind="stable"), axis=1)
    low, high = rank[arcs].T
    # arc e above level k is piece start[e] + k - low[e]; its crossing with level k is the same behind all nodes
    start = np.cumsum(high - low) - (high - low)

    def crossing(arc: Integers, level: Integers) -> Integers:
        inside = count + start[arc] + level - low[arc]
        return np.where(level == low[arc], arcs[arc, 0], np.where(level == high[arc], arcs[arc, 1], inside))

    corners = np.take_along_axis(triangles, np.argsort(rank[triangles], axis=1, kind="stable"), axis=1)
    long, lower, upper = (_arc_between(arcs, corners[:, ends], count) for ends in ([0, 2], [0, 1], [1, 2]))
    face, level = _levels_of(low[long], high[long])
    beside = np.where(level < rank[corners[face, 1]], lower[face], upper[face])
    pieces = _components(int((high - low).sum()), *(start[e] + level - low[e] for e in (long[face], beside)))
    face, level = _levels_of(low[long], high[long] + 1)
    beside = np.where(level <= rank[corners[face, 1]], lower[face], upper[face])
    flat = arcs[low == high]
    contours = _components(
        count + len(pieces),
        np.concatenate([flat[:, 0], crossing(long[face], level)]),
        np.concatenate([flat[:, 1], crossing(beside, level)]),
    )
    arc, level = _levels_of(low, high)
    first = np.unique(pieces, return_index=True)[1]
    ends = np.stack([contours[crossing(arc[first], level[first] + step)] for step in (0, 1)], axis=1)
    heights = np.empty(int(contours.max(initial=-1)) + 1)
    heights[contours[:count]] = values
    heights[ends] = levels[np.stack([level[first], level[first] + 1], axis=1)]
    return _without_regular_nodes(heights, ends, np.unique(contours[:count]))


def _levels_of(low: Integers, high: Integers) -> tuple[Integers, Integers]:
    """Return all pairs of a position and a whole number in its range."""
    sizes = high - low
    owner = np.repeat(np.arange(len(low)), sizes)
    return owner, np.arange(len(owner)) - np.repeat(np.cumsum(sizes) - sizes, sizes) + low[owner]


def _components(count: int, first: Integers, second: Integers) -> Integers:
    joined = coo_array((np.ones(len(first), dtype=np.int8), (first, second)), shape=(count, count))
    return connected_components(joined, directed=False)[1].astype(np.int64) if count else np.zeros(0, dtype=np.int64)


def _arc_between(arcs: Integers, pairs: Integers, count: int) -> Integers:
    """Return the arc of each pair of nodes."""
    keys, wanted = (np.sort(some, axis=1) @ np.array([count, 1]) for some in (arcs, pairs))
    order = np.argsort(keys, kind="stable")
    at = np.searchsorted(keys, wanted, sorter=order)
    found = order[np.minimum(at, len(order) - 1)] if len(order) else np.zeros(len(at), dtype=np.int64)
    if len(wanted) and (not len(order) or (keys[found] != wanted).any()):
        raise ValueError("a side of a triangle is no arc, triangles need all three of theirs")
    return found


def _without_regular_nodes(heights: Floats, arcs: Integers, nodes: Integers) -> LevelGraph:
    """Join the arcs that meet at a node with one arc below and one above, and number the others."""
    below, above = (np.bincount(arcs[:, side], minlength=len(heights)) for side in (1, 0))
    regular = (below == 1) & (above == 1)
    under, over = (np.full(len(heights), -1, dtype=np.int64) for _ in range(2))
    under[arcs[:, 1]], over[arcs[:, 0]] = np.arange(len(arcs)), np.arange(len(arcs))
    label = _components(len(arcs), under[regular], over[regular])
    ends = [arcs[~regular[arcs[:, side]], side][np.argsort(label[~regular[arcs[:, side]]])] for side in (0, 1)]
    kept, places = np.unique(np.concatenate([*ends, nodes[~regular[nodes]]]), return_inverse=True)
    return LevelGraph(heights[kept], places[: 2 * len(ends[0])].reshape(2, -1).T)
