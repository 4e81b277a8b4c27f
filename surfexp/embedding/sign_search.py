"""Exact minimisation over the signs of n eigenfunctions: enumeration, branch and bound, and the proof of either."""

from __future__ import annotations

import heapq
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats

Signs = NDArray[np.int8]
Bound = Callable[[Signs, float], float]
Progress = Callable[[int, float], None]
LARGEST_ENUMERATION = 5


@dataclass(frozen=True, eq=False)
class SignSearch:
    """The best signs that were found and how good they are.

    Parameters
    ----------
    signs : (n,) int8
    value : float
        Objective at `signs`.
    lower_bound : float
        No signs have a smaller objective.
    optimal : bool
        Whether the bound proves that `signs` are best, to rounding.
    evaluations : int
        How often the objective or its bound was evaluated.
    closed : (c, n) int8
        The log: signs that were decided (0 is undecided) of every node at which the search turned back. Unless the search
        was stopped, each of the 2^n signs belongs to exactly one of them.
    bounds : (c,) float64
        Lower bound of the objective below each closed node.
    """

    signs: Signs
    value: float
    lower_bound: float
    optimal: bool
    evaluations: int
    closed: Signs
    bounds: Floats


def enumerate_signs(objective: Bound, n: int) -> SignSearch:
    """Evaluate all 2^n signs, each until it is known to be worse than the best before it."""
    codes = np.arange(2**n)[:, None] >> np.arange(n - 1, -1, -1)
    closed = (1 - 2 * (codes & 1)).astype(np.int8)
    values = np.full(len(closed), np.inf)
    for row, signs in enumerate(closed):
        values[row] = objective(signs, float(values.min()))
    best = int(values.argmin())
    return SignSearch(closed[best], float(values[best]), float(values[best]), True, len(values), closed, values)


def greedy_signs(objective: Bound, n: int) -> tuple[Signs, int]:
    """Decide one sign after the other by the smaller bound; return signs and number of evaluations."""
    signs = np.zeros(n, np.int8)
    for k in range(n):
        bounds = []
        for sign in (1, -1):
            signs[k] = sign
            bounds.append(objective(signs, np.inf))
        signs[k] = 1 if bounds[0] <= bounds[1] else -1
    return signs, 2 * n


def branch_and_bound(
    objective: Bound, n: int, start: Signs | None = None, limit: int = 100_000, progress: Progress | None = None
) -> SignSearch:
    """Search the tree of signs best bound first, and stop when no open node can beat what is known.

    Nodes on the way to the best signs known cannot be closed, so they are split without being evaluated: with the right
    start, n + 1 evaluations can prove it best.

    Parameters
    ----------
    objective : callable
        Takes (n,) int8 signs, 0 where undecided, and a cutoff. Returns the objective when all are decided, else a number
        that no completion undercuts; once it knows that the result exceeds the cutoff it may return any such number above it.
    n : int
    start : (n,) int8, optional
        Signs from which the search begins; default: greedy.
    limit : int
        Most evaluations; when they are used up, the least bound of the open nodes is the lower bound.
    progress : callable, optional
        Called with the number of evaluations and the gap between the value and what is proved, over the value.
    """
    evaluations = 0
    if start is None:
        start, evaluations = greedy_signs(objective, n)
    signs = np.asarray(start, np.int8).copy()
    value = objective(signs, np.inf)
    evaluations += 1
    closed, bounds = [signs.copy()], [value]
    queue: list[tuple[float, int, bytes]] = [(-np.inf, 0, np.zeros(n, np.int8).tobytes())]
    while queue and evaluations < limit:
        bound, depth, code = heapq.heappop(queue)
        if progress is not None and value > 0:
            progress(evaluations, max(1.0 - max(bound, 0.0) / value, 0.0))
        node = np.frombuffer(code, np.int8)
        if bound >= value:
            closed.append(node)
            bounds.append(bound)
            continue
        depth = -depth
        for sign in (1, -1):
            child = node.copy()
            child[depth] = sign
            if depth + 1 == n and (child == closed[0]).all():
                continue
            if (child[: depth + 1] == signs[: depth + 1]).all() and depth + 1 < n:
                heapq.heappush(queue, (bound, -depth - 1, child.tobytes()))
                continue
            found = max(objective(child, value), bound)
            evaluations += 1
            if depth + 1 < n and found < value:
                heapq.heappush(queue, (found, -depth - 1, child.tobytes()))
                continue
            closed.append(child)
            bounds.append(found)
            if depth + 1 == n and found < value:
                signs, value = child.copy(), found
    for bound, _, code in sorted(queue):
        node = np.frombuffer(code, np.int8)
        closed.append(node)
        bounds.append(bound if bound > -np.inf else objective(node, np.inf))
    lower = float(min(bounds))
    return SignSearch(signs, value, lower, lower >= value, evaluations, np.array(closed), np.array(bounds))


def search_signs(
    objective: Bound, n: int, start: Signs | None = None, limit: int = 100_000, progress: Progress | None = None
) -> SignSearch:
    """Enumerate up to 5 signs, branch and bound above."""
    if n < 1:
        raise ValueError(f"n = {n} signs, take at least 1")
    if limit < 2:
        raise ValueError(f"limit = {limit} evaluations, take at least 2")
    if n <= LARGEST_ENUMERATION and 2**n <= limit:
        return enumerate_signs(objective, n)
    return branch_and_bound(objective, n, start, limit, progress)
