"""Short branches cut from a sampled Reeb graph, by persistence."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Integers
from surfexp.skeleton.skeleton import CAP, JUNCTION, Skeleton, graph_metrics

Arcs = list[set[int]]


def pruned(skeleton: Skeleton, persistence: float) -> Skeleton:
    """Cut off branches whose feature changes by less than a share of its whole range, the least first.

    A branch runs from a cap to a junction that has another arc on the same side, so that neither the ends of the whole nor
    loops are ever cut. A junction that only passes through afterwards is taken out.

    Parameters
    ----------
    skeleton : Skeleton
        A Reeb graph with levels.
    persistence : float
        In 0..1; 0 changes nothing.

    Returns
    -------
    Skeleton
        With "cut_branches" among its metrics, which are counted anew; the contours of the branches are gone.

    Raises
    ------
    ValueError
        If the persistence is not in 0..1.
    """
    upper, alive, cuts = _cut(skeleton, persistence)
    return _remaining(skeleton, upper, alive, cuts)


def surviving_nodes(skeleton: Skeleton, persistence: float) -> NDArray[np.bool_]:
    """(N,) which nodes of a skeleton `pruned` leaves."""
    return _cut(skeleton, persistence)[1]


def _cut(skeleton: Skeleton, persistence: float) -> tuple[Arcs, NDArray[np.bool_], int]:
    if not 0.0 <= persistence <= 1.0:
        raise ValueError(f"persistence is {persistence}, a share of the feature's range in 0..1 is needed")
    lower: Arcs = [set() for _ in skeleton.positions]
    upper: Arcs = [set() for _ in skeleton.positions]
    for a, b in skeleton.arcs.tolist():
        upper[a].add(b)
        lower[b].add(a)
    threshold, cuts = persistence * float(np.ptp(skeleton.values)), 0
    alive = np.ones(len(lower), dtype=bool)
    while branches := _branches(skeleton, lower, upper, alive, threshold):
        _, branch, fork = min(branches)
        cuts += 1
        for node in branch:
            for other in lower[node]:
                upper[other].discard(node)
            for other in upper[node]:
                lower[other].discard(node)
            alive[node] = False
        if len(lower[fork]) == 1 and len(upper[fork]) == 1:
            (below,), (above,) = lower[fork], upper[fork]
            upper[below] = upper[below] - {fork} | {above}
            lower[above] = lower[above] - {fork} | {below}
            alive[fork] = False
    return upper, alive, cuts


def _branches(
    skeleton: Skeleton, lower: Arcs, upper: Arcs, alive: np.ndarray, threshold: float
) -> list[tuple[float, list[int], int]]:
    found = []
    for cap in np.flatnonzero(alive & (skeleton.kinds == CAP)).tolist():
        if len(lower[cap]) + len(upper[cap]) != 1:
            continue
        rising = not lower[cap]
        branch, node = [cap], next(iter(upper[cap] if rising else lower[cap]))
        while skeleton.kinds[node] != JUNCTION and len(lower[node]) + len(upper[node]) == 2:
            branch.append(node)
            node = next(iter(upper[node] if rising else lower[node]))
        size = abs(float(skeleton.values[node] - skeleton.values[cap]))
        if size < threshold and len(lower[node] if rising else upper[node]) > 1:
            found.append((size, branch, node))
    return found


def _remaining(skeleton: Skeleton, upper: Arcs, alive: np.ndarray, cuts: int) -> Skeleton:
    kept, number = np.flatnonzero(alive), np.cumsum(alive) - 1
    pairs = [(int(number[a]), int(number[b])) for a in kept for b in sorted(upper[a])]
    arcs: Integers = np.array(pairs, dtype=np.int64).reshape(-1, 2)
    counts = np.diff(skeleton.contour_starts)
    owner = np.repeat(np.arange(len(alive)), counts)
    metrics = {**skeleton.metrics, **graph_metrics(arcs, len(kept)), "cut_branches": float(cuts)}
    metrics["contours"] = float((skeleton.level_index[kept] >= 0).sum())
    return replace(
        skeleton,
        positions=skeleton.positions[kept],
        kinds=skeleton.kinds[kept],
        values=skeleton.values[kept],
        lengths=skeleton.lengths[kept],
        closed=skeleton.closed[kept],
        level_index=skeleton.level_index[kept],
        arcs=arcs,
        contour_points=skeleton.contour_points[alive[owner]],
        contour_starts=np.concatenate([[0], np.cumsum(counts[kept])]).astype(np.int64),
        metrics=metrics,
    )
