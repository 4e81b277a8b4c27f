"""Threshold-free cluster enhancement (Smith and Nichols 2009) as an exact integral, by the merge tree of a map."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats, Integers
from surfexp.inference.vertex_graph import VertexGraph
from surfexp.mesh.union_find import find_root

NONE = -1


def enhanced(
    values: Floats,
    graph: VertexGraph,
    *,
    extent_power: float = 1.0,
    height_power: float = 2.0,
    two_sided: bool = True,
    step: float | None = None,
) -> Floats:
    """Return the threshold-free cluster enhancement of a map, exact to rounding.

    At a vertex v of value t it is the integral over h from 0 to |t| of a(h)^E h^H, where a(h) is the area of the cluster of v
    at the threshold h: of the connected vertices of the same sign whose value is at least h in modulus. As h falls, clusters
    grow only where it meets a value. The integral is therefore a sum over the merge tree of the map, without a step, after
    one sort.

    Parameters
    ----------
    values : (n,) float64
        A map of a statistic; NaN belongs to no cluster.
    graph : VertexGraph
    extent_power, height_power : float
        E and H. 1 and 2 are those of FSL and PALM for surfaces, 0.5 and 2 those for volumes.
    two_sided : bool
        Whether negative values form clusters of their own, with a negative result; else they are outside.
    step : float, optional
        Take the sum of a(h)^E h^H step over h = step, 2 step, ... instead, as other programs do, to compare with them.

    Returns
    -------
    (n,) float64
        0 outside, of the sign of the value elsewhere.

    Raises
    ------
    ValueError
        If the step is not above 0.

    References
    ----------
    Smith and Nichols: Threshold-free cluster enhancement: addressing problems of smoothing, threshold dependence and
    localisation in cluster inference (2009).
    """
    outside = ~np.isfinite(values) if two_sided else ~(np.isfinite(values) & (values > 0.0))
    inside = np.where(outside, 0.0, values)
    # descending; numpy sorts floats faster than a compiled loop
    order = np.argsort(-np.abs(inside))
    levels = _levels(np.abs(inside), height_power, step)
    return np.asarray(_enhanced(inside, levels, order, graph.starts, graph.neighbours, graph.areas, extent_power))


def _levels(heights: Floats, height_power: float, step: float | None) -> Floats:
    """What h^H adds up to from 0 to each height: the integral, or the sum over steps."""
    if step is None:
        return np.asarray(heights ** (height_power + 1.0) / (height_power + 1.0))
    if not step > 0.0:
        raise ValueError(f"step = {step:g}, a number above 0 is needed")
    steps = step * np.arange(1, int(heights.max(initial=0.0) / step) + 2)
    sums = np.append(0.0, np.cumsum(steps**height_power * step))
    return np.asarray(sums[np.searchsorted(steps, heights, side="right")])


@njit(cache=True, nogil=True)
def _power(base: float, exponent: float) -> float:
    if exponent == 1.0:
        return base
    return float(np.sqrt(base)) if exponent == 0.5 else base**exponent


@njit(cache=True, nogil=True)
def _enhanced(
    values: Floats,
    levels: Floats,
    order: Integers,
    starts: Integers,
    neighbours: Integers,
    areas: Floats,
    extent_power: float,
) -> Floats:
    """Sweep the threshold down: a vertex takes the clusters that it touches below itself, and is the root of what becomes."""
    n = len(values)
    roots, below = np.full(n, NONE), np.full(n, NONE)
    area, gain = areas.copy(), np.zeros(n)
    for v in order:
        if values[v] == 0.0:
            break
        roots[v] = v
        for at in range(starts[v], starts[v + 1]):
            u = neighbours[at]
            if roots[u] == NONE or (values[u] > 0.0) != (values[v] > 0.0):
                continue
            root = find_root(roots, u)
            if root != v:
                roots[root], below[root] = v, v
                gain[root] = _power(area[root], extent_power) * (levels[root] - levels[v])
                area[v] += area[root]
    # up from the thresholds near 0, so that only terms of one sign are added
    for v in order[::-1]:
        if roots[v] == NONE:
            continue
        if below[v] == NONE:
            gain[v] = _power(area[v], extent_power) * levels[v]
        else:
            gain[v] += gain[below[v]]
    for v in range(n):
        gain[v] = np.copysign(gain[v], values[v])
    return gain
