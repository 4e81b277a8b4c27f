"""Polygonal lines in space: length, even resampling, distance of points from a line, and the trunk of a skeleton."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.skeleton.skeleton import Skeleton, chain_order


def polyline_length(points: Floats) -> float:
    """Sum of the distances between successive points."""
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def evenly_resampled(points: Floats, count: int) -> Floats:
    """(count, d) points at equal steps of arc length, the ends among them.

    Raises
    ------
    ValueError
        If fewer than two points are given or asked for, or the line has no length.
    """
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    if len(points) < 2 or count < 2 or not steps.sum() > 0:
        raise ValueError(
            f"a line of {len(points)} points and length {steps.sum():g} cannot be resampled at {count} points"
        )
    travelled = np.concatenate([[0.0], np.cumsum(steps)])
    places = np.linspace(0.0, travelled[-1], count)
    return np.stack([np.interp(places, travelled, x) for x in points.T], axis=1)


def distance_from_line(points: Floats, line: Floats) -> tuple[Floats, Floats]:
    """Distances of points from a polygonal line, and where on the line (arc length) they are nearest.

    Parameters
    ----------
    points : (p, d) float64
    line : (q, d) float64

    Returns
    -------
    distances, places : (p,) float64
    """
    start, step = line[:-1], np.diff(line, axis=0)
    sizes = np.linalg.norm(step, axis=1)
    best, place = np.full(len(points), np.inf), np.zeros(len(points))
    travelled = np.concatenate([[0.0], np.cumsum(sizes)])
    for i in range(len(start)):
        offset = points - start[i]
        share = np.clip(offset @ step[i] / max(sizes[i] ** 2, 1e-300), 0.0, 1.0)
        distance = np.linalg.norm(offset - share[:, None] * step[i], axis=1)
        nearer = distance < best
        best[nearer], place[nearer] = distance[nearer], (travelled[i] + share * sizes[i])[nearer]
    return best, place


def trunk(skeleton: Skeleton) -> Integers:
    """Nodes on the path from the node of lowest value to that of the highest, the whole of a chain.

    Where the graph has loops it is a path with the fewest nodes.

    Raises
    ------
    ValueError
        If the two lie in different components.
    """
    if skeleton.is_chain:
        return chain_order(skeleton)
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import breadth_first_order

    count, (a, b) = len(skeleton.positions), skeleton.arcs.T
    graph = coo_array((np.ones(2 * len(a)), (np.concatenate([a, b]), np.concatenate([b, a]))), shape=(count, count))
    first, last = int(np.argmin(skeleton.values)), int(np.argmax(skeleton.values))
    before = breadth_first_order(graph.tocsr(), first, directed=False, return_predecessors=True)[1]
    path = [last]
    while path[-1] != first:
        if before[path[-1]] < 0:
            raise ValueError(
                f"skeleton {skeleton.name!r} has {int(skeleton.metrics['components'])} components, one is needed"
            )
        path.append(int(before[path[-1]]))
    return np.array(path[::-1], dtype=np.int64)


def trunk_contours(skeleton: Skeleton) -> Floats:
    """(k, 3) positions of the contours on the trunk: the polyline of the text, without its extrema."""
    nodes = trunk(skeleton)
    on_levels = nodes[skeleton.level_index[nodes] >= 0]
    return skeleton.positions[on_levels if len(on_levels) else nodes]
