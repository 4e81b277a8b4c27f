"""Large embeddings by few of their points: distances are searched on these, and what that can change is bounded."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numba import njit
from scipy.sparse import csr_array
from scipy.spatial import cKDTree

from surfexp.contract.arrays import Floats, Integers
from surfexp.embedding.distance import Distance
from surfexp.embedding.spectral_embedding import SpectralEmbedding

# radius of a cover by n points that are taken in random order, over the mean distance to the nearest of n random points:
# disks of half the radius fill .547 of the plane (random sequential adsorption), and the mean distance is .5 by density
RADIUS_OF_COVER = 1.67
# a cover by fewer points than this share is made again, where vertices are too few for that estimate
FEWER, COVERS = 0.8, 4
TWICE = 1.0


@dataclass(frozen=True, eq=False)
class Represented:
    """An embedding and points of it that stand for the others.

    Parameters
    ----------
    whole, few : SpectralEmbedding
        A point of `few` weighs what those weigh for which it stands.
    rows : (m,) int64
        Row in `whole` of each representative.
    mean, radius : float
        Mean distance, by weight, and largest distance of a point from its representative. They bound what representatives
        change: distances to a set are 1-Lipschitz, under any orthogonal matrix and under absolute values too.
    """

    whole: SpectralEmbedding
    few: SpectralEmbedding
    rows: Integers
    mean: float
    radius: float


def represented(whole: SpectralEmbedding, count: int, seed: int = 0) -> Represented:
    """Choose about `count` points within a small radius of which all points lie.

    Points are taken in random order, unless one before is within the radius.

    Parameters
    ----------
    whole : SpectralEmbedding
    count : int
        With as many points or fewer each represents itself.
    seed : int

    Returns
    -------
    Represented
    """
    size = len(whole.points)
    if size <= count:
        every = np.arange(size)
        return Represented(whole, whole, every, 0.0, 0.0)
    order = np.random.default_rng(seed).permutation(size)
    to_random = cKDTree(whole.points[order[:count]]).query(whole.points)[0]
    radius = RADIUS_OF_COVER * float(to_random @ whole.weights)
    tree = cKDTree(whole.points, balanced_tree=False, compact_nodes=False)
    for _ in range(COVERS):
        rows = _cover(tree, order, radius)
        if len(rows) > FEWER * count:
            break
        radius *= np.sqrt(len(rows) / count)
    distances, owner = cKDTree(whole.points[rows]).query(whole.points)
    weights = np.zeros(len(rows))
    np.add.at(weights, owner, whole.weights)
    few = replace(whole, points=whole.points[rows], weights=weights)
    return Represented(whole, few, rows, float(distances @ whole.weights), float(distances.max()))


def _cover(tree: cKDTree, order: Integers, radius: float) -> Integers:
    covered, chosen = np.zeros(tree.n, bool), []
    for row in order:
        if not covered[row]:
            chosen.append(row)
            covered[tree.query_ball_point(tree.data[row], radius)] = True
    return np.sort(np.array(chosen, dtype=np.int64))


def distance_by_representatives(
    source: Represented,
    target: Represented,
    edges: tuple[csr_array, csr_array],
    measure: Callable[[SpectralEmbedding, SpectralEmbedding], Distance],
) -> Distance:
    """Measure the distance of representatives, and carry basis, value and bound to all points.

    The value is that of the matches of all points (see `matched`): the distance in this basis is no larger, and may be smaller.

    Parameters
    ----------
    source, target : Represented
    edges : (v, v) csr_array, (v, v) csr_array
        Neighbours of each point of source and target.
    measure : callable
        Distance of two embeddings with its proof, mean Hausdorff in both directions.

    Returns
    -------
    Distance
        The distance of points from their representatives comes off its bound, so that it is proved least only where it is 0;
        a note says how much. It has no log of a search.
    """
    found = measure(source.few, target.few)
    moved = target.whole.points @ found.basis
    points, (own, other) = source.whole.points, edges
    correspondence, backward = matched(moved, other, points, own)
    _, forward = matched(points, own, moved, other)
    figures = {
        "forward": float(forward @ source.whole.weights),
        "backward": float(backward @ target.whole.weights),
        "hausdorff": float(max(forward.max(), backward.max())),
    }
    value = max(figures["forward"], figures["backward"])
    lost = max(source.mean + target.radius, target.mean + source.radius)
    lower = min(max(found.lower_bound - lost, 0.0), value)
    optimal = lower >= value
    few = " and ".join(f"{len(one.rows):,} of {len(one.whole.points):,}" for one in (source, target))
    note = (
        f"In the search {few} vertices stand for the others: the lower bound is {lost:.3g} less for it, and "
        "symmetries were not looked for."
    )
    figures |= {"distance": value, "lower_bound": lower, "gap": value - lower, "optimal": float(optimal)}
    return replace(
        found,
        value=value,
        lower_bound=lower,
        optimal=optimal,
        source_points=points,
        target_points=moved,
        correspondence=correspondence,
        closed=np.zeros((0, 0), np.int64),
        bounds=np.zeros(0),
        metrics={**found.metrics, **figures},
        notes=(*found.notes, note),
    )


def matched(points: Floats, own_edges: csr_array, others: Floats, edges: csr_array) -> tuple[Integers, Floats]:
    """Match each point with another of a surface that is at most twice as far as the nearest, and mostly is the nearest.

    In many dimensions the nearest takes a tree a hundred times as long as one that is at most twice as far. From this a point
    goes along edges of the others to the nearest neighbour until none is nearer, and begins again at the match of a neighbour
    of its own where that is nearer, until nothing changes.

    Parameters
    ----------
    points : (p, n) float64
    own_edges : (p, p) csr_array
    others : (q, n) float64
    edges : (q, q) csr_array

    Returns
    -------
    (p,) int64, (p,) float64
        Row of the others, and the distance to it.
    """
    own, theirs = ((graph.indptr.astype(np.int64), graph.indices.astype(np.int64)) for graph in (own_edges, edges))
    start = cKDTree(others, balanced_tree=False, compact_nodes=False).query(points, eps=TWICE, workers=-1)[1]
    return _matched(points, *own, others, *theirs, start.astype(np.int64))


@njit(cache=True, nogil=True)
def _matched(
    points: Floats,
    own_starts: Integers,
    own: Integers,
    others: Floats,
    starts: Integers,
    neighbours: Integers,
    start: Integers,
) -> tuple[Integers, Floats]:  # pragma: no cover - compiled
    count = len(points)
    rows, squares = np.full(count, -1), np.full(count, np.inf)
    for i in range(count):
        rows[i], squares[i] = _descended(points[i], others, starts, neighbours, start[i])
    changed, forward = True, True
    while changed:
        changed = False
        for step in range(count):
            i = step if forward else count - 1 - step
            for k in range(own_starts[i], own_starts[i + 1]):
                candidate = rows[own[k]]
                if candidate != rows[i] and _squared(points[i], others[candidate]) < squares[i]:
                    rows[i], squares[i] = _descended(points[i], others, starts, neighbours, candidate)
                    changed = True
        forward = not forward
    return rows, np.sqrt(squares)


@njit(cache=True, nogil=True)
def _descended(
    point: Floats, others: Floats, starts: Integers, neighbours: Integers, start: int
) -> tuple[int, float]:  # pragma: no cover - compiled
    best, least = start, _squared(point, others[start])
    here = -1
    while here != best:
        here = best
        for k in range(starts[here], starts[here + 1]):
            found = _squared(point, others[neighbours[k]])
            if found < least:
                best, least = neighbours[k], found
    return best, least


@njit(cache=True, nogil=True)
def _squared(one: Floats, other: Floats) -> float:  # pragma: no cover - compiled
    total = 0.0
    for k in range(len(one)):
        total += (one[k] - other[k]) ** 2
    return total
