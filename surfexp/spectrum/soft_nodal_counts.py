"""Soft nodal numbers: nodal domains weighed by how clearly they are there, continuous in the function."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.union_find import find_root
from surfexp.spectrum.nodal_graph import NodalGraph


def soft_nodal_counts(graph: NodalGraph, vectors: Floats, saddles: Floats, peaks: Floats) -> Floats:
    """Return for each column the sum over its peaks of how sure they are domains of their own.

    A peak of height b that joins a higher one over a saddle of height d (0-dimensional persistence of the superlevel sets
    of f and of -f) weighs ramp(b / peak) (1 - ramp(d / saddle)), where ramp rises from 0 at 1/2 to 1 at 3/2: the count of
    `filtered_nodal_counts` with its two steps made gradual.

    Parameters
    ----------
    graph : NodalGraph
        Of n nodes.
    vectors : (n, k) float64
    saddles, peaks : (k,) float64
        Heights of half weight, positive, in the unit of the functions; saddles <= peaks.

    Raises
    ------
    ValueError
        If a height is not positive or the sizes differ.
    """
    if min(np.min(saddles), np.min(peaks)) <= 0:
        raise ValueError(
            f"heights of half weight reach down to {min(np.min(saddles), np.min(peaks)):g}, they must be positive"
        )
    if len(graph.starts) != len(vectors) + 1:
        raise ValueError(f"the functions have {len(vectors)} rows, the graph has {len(graph.starts) - 1} nodes")
    result = np.empty(vectors.shape[1])
    for c in range(vectors.shape[1]):
        result[c] = sum(
            _weigh(graph.starts, graph.neighbours, side, _descending(side, saddles[c]), saddles[c], peaks[c])
            for side in (np.ascontiguousarray(vectors[:, c]), np.ascontiguousarray(-vectors[:, c]))
        )
    return result


def _descending(values: Floats, saddle: float) -> Integers:
    """Nodes above saddle / 2, highest first; below it all joints weigh the same."""
    above = np.flatnonzero(values > 0.5 * saddle)
    return above[np.argsort(-values[above], kind="stable")]


@njit(cache=True, nogil=True)
def _ramp(height: float) -> float:
    return max(0.0, min(1.0, height - 0.5))


@njit(cache=True, nogil=True)
def _weigh(
    starts: Integers, neighbours: Integers, values: Floats, order: Integers, saddle: float, peak: float
) -> float:
    parents = np.full(len(values), -1, np.int64)  # the root of a piece is its peak
    total = 0.0
    for node in order:
        parents[node] = node
        for p in range(starts[node], starts[node + 1]):
            if parents[neighbours[p]] < 0:
                continue
            high, low = find_root(parents, node), find_root(parents, neighbours[p])
            if high == low:
                continue
            if values[high] < values[low]:
                high, low = low, high
            parents[low] = high
            if low != node:
                total += _ramp(values[low] / peak) * (1.0 - _ramp(values[node] / saddle))
    for node in order:
        if parents[node] == node:
            total += _ramp(values[node] / peak)
    return total
