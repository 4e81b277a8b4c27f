"""How thick a surface is along its skeleton: radii of contours, and branches with their lengths."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats, Integers


def contour_radii(
    middles: Floats, points: Floats, starts: Integers, closed: NDArray[np.bool_], arcs: Integers
) -> Floats:
    """Return the mean distance of the points of each contour, by length, from the axis of the surface there.

    The axis runs through the middle of the contour in the direction of the skeleton. A contour that cuts a round tube aslant
    is an ellipse; its distance from the axis is the radius all the same, while that from the middle is larger.

    Parameters
    ----------
    middles : (N, 3) float64
    points : (P, 3) float64
    starts : (N + 1,) int64
        Contour i is points[starts[i] : starts[i + 1]].
    closed : (N,) bool
    arcs : (A, 2) int64
        Between nodes, from the lower to the higher value.

    Returns
    -------
    (N,) float64
        0 for a contour that is a point, NaN where there is none. Where no other contour is next to one, from its middle.
    """
    counts = np.diff(starts)
    owner, there = np.repeat(np.arange(len(counts)), counts), counts > 0
    following = np.arange(1, len(points) + 1)
    last = starts[1:][there] - 1
    following[last] = np.where(closed[there], starts[:-1][there], last)
    axes = _directions(middles, arcs[there[arcs].all(axis=1)])[owner]

    def distances(places: Floats) -> Floats:
        offsets = places - middles[owner]
        return np.linalg.norm(offsets - np.einsum("ij,ij->i", offsets, axes)[:, None] * axes, axis=1)

    ends, between = distances(points), distances(0.5 * (points + points[following]))
    sizes = np.linalg.norm(points[following] - points, axis=1)
    # Simpson's rule on each segment
    sums = np.bincount(owner, sizes * (ends + 4.0 * between + ends[following]) / 6.0, len(counts))
    lengths = np.bincount(owner, sizes, len(counts))
    radii = np.divide(sums, lengths, out=np.zeros(len(counts)), where=lengths > 0.0)
    return np.where(there, radii, np.nan)


def _directions(positions: Floats, arcs: Integers) -> Floats:
    """The mean direction of the arcs at each node, of length 1; 0 where there is none."""
    steps = _units(positions[arcs[:, 1]] - positions[arcs[:, 0]])
    sums = np.zeros_like(positions)
    for side in arcs.T:
        np.add.at(sums, side, steps)
    return _units(sums)


def _units(vectors: Floats) -> Floats:
    sizes = np.linalg.norm(vectors, axis=1)[:, None]
    return np.divide(vectors, sizes, out=np.zeros_like(vectors), where=sizes > 1e-12 * sizes.max(initial=0.0))


def branch_paths(arcs: Integers, count: int) -> list[list[int]]:
    """Return the paths of a graph between nodes that do not have two arcs; a ring without one begins anywhere on it.

    Parameters
    ----------
    arcs : (A, 2) int64
    count : int
        Of nodes.

    Returns
    -------
    list of list of int
        Each arc is on one path.
    """
    around: list[list[int]] = [[] for _ in range(count)]
    for number, pair in enumerate(arcs.tolist()):
        for node in pair:
            around[node].append(number)
    walked = np.zeros(len(arcs), dtype=bool)
    ends = [node for node in range(count) if len(around[node]) != 2]
    paths = []
    for start in [*ends, *range(count)]:
        for first in around[start]:
            path, arc = [start], first
            while not walked[arc]:
                walked[arc] = True
                a, b = arcs[arc].tolist()
                path.append(b if path[-1] == a else a)
                if len(beside := around[path[-1]]) == 2:
                    arc = beside[0] if beside[1] == arc else beside[1]
            if len(path) > 1:
                paths.append(path)
    return paths


def branch_table(positions: Floats, kinds: NDArray[np.str_], arcs: Integers, radii: Floats) -> dict[str, list[Any]]:
    """Return branches as columns.

    Parameters
    ----------
    positions : (N, 3) float64
    kinds : (N,) str
        "contour", "cap" or "junction".
    arcs : (A, 2) int64
    radii : (N,) float64

    Returns
    -------
    dict of str to list
        See `surfexp.skeleton.skeleton.Skeleton.branches`.
    """
    rows = []
    for path in branch_paths(arcs, len(positions)):
        own = radii[[node for node in path if kinds[node] == "contour" and np.isfinite(radii[node])]]
        numbers = (np.median(own), own.min(), own.max()) if len(own) else (np.nan,) * 3
        length = np.linalg.norm(np.diff(positions[path], axis=0), axis=1).sum()
        ends = (path[0], path[-1])
        rows.append((*ends, *(str(kinds[node]) for node in ends), len(path), *map(float, (length, *numbers))))
    names = ("first", "last", "from", "to", "nodes", "length", "radius", "smallest", "largest")
    return {name: [row[k] for row in rows] for k, name in enumerate(names)}
