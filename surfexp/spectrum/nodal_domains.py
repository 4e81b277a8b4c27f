"""Nodal domains: connected pieces in which an eigenfunction keeps its sign, for many functions at once."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats, Integers
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.nodal_graph import NodalGraph

BRIDGE, HIGHEST_BRIDGE, PEAK = 0.5, 0.25, 2.0


def nodal_counts(graph: NodalGraph, vectors: Floats) -> Integers:
    """Return the nodal number of each column as published (definition 4.3.1, section 4.3): pieces of nodes of one sign.

    Nodes at exactly 0 (a Dirichlet boundary) belong to no piece. These raw counts are unreliable near crossings of nodal
    lines and where Dirichlet functions are tiny; see `filtered_nodal_counts`.
    """
    return filtered_nodal_counts(graph, vectors, np.zeros(vectors.shape[1]), np.zeros(vectors.shape[1]))


def filtered_nodal_counts(graph: NodalGraph, vectors: Floats, saddles: Floats, peaks: Floats) -> Integers:
    """Return the number of pieces of |f| >= saddle, of one sign, that reach a peak |f| >= peak.

    Raising the level from 0 opens the narrow bridges that a mesh builds where nodal lines cross, and asking for a peak
    drops domains that are noise.

    Parameters
    ----------
    graph : NodalGraph
        Of n nodes.
    vectors : (n, k) float64
    saddles, peaks : (k,) float64
        Thresholds, in the unit of the functions; saddles <= peaks.
    """
    _check(graph, vectors)
    columns = np.ascontiguousarray(vectors.T)
    return _count(*graph.sweep, columns, np.asarray(saddles, float), np.asarray(peaks, float))


def nodal_thresholds(values: Floats, area: float, node_count: int) -> tuple[Floats, Floats]:
    """Return thresholds for `filtered_nodal_counts` of B-normalised functions, by the resolution of the mesh.

    Where nodal lines cross, a side of length h that passes the crossing has ends of height about lambda h^2 / 4, in units
    of the function's root mean square 1 / sqrt(area), and bridges two domains. The saddle threshold is twice that, at most
    a quarter; peaks need twice the threshold.

    Parameters
    ----------
    values : (k,) float64
        Eigenvalues.
    area : float
    node_count : int
        h^2 = area / node_count.

    Returns
    -------
    saddles, peaks : (k,) float64
    """
    heights = np.clip(BRIDGE * values * area / node_count, 0.0, HIGHEST_BRIDGE) / np.sqrt(area)
    return heights, PEAK * heights


def cluster_averaged_counts(
    graph: NodalGraph, system: EigenSystem, saddles: Floats, peaks: Floats, draws: int = 20, seed: int = 0
) -> tuple[Floats, Floats]:
    """Return mean and standard deviation of the filtered counts over random bases of each cluster of eigenvalues.

    In an eigenspace of several dimensions the nodal number depends on the basis (the "one weak point" of section 4.3);
    simple modes have deviation 0.
    """
    mean = filtered_nodal_counts(graph, system.vectors, saddles, peaks).astype(np.float64)
    deviation = np.zeros_like(mean)
    rng = np.random.default_rng(seed)
    for start, stop in system.clusters:
        counts = np.empty((draws, stop - start))
        for draw in range(draws):
            rotation = np.linalg.qr(rng.normal(size=(stop - start, stop - start)))[0]
            turned = system.vectors[:, start:stop] @ rotation
            counts[draw] = filtered_nodal_counts(graph, turned, saddles[start:stop], peaks[start:stop])
        mean[start:stop], deviation[start:stop] = counts.mean(), counts.std()
    return mean, deviation


def courant_violations(counts: Integers) -> Integers:
    """Return the indices i, from 0, at which Courant's bound, count <= i + 1, is broken (Courant; Cheng 1976).

    Counted from 0, the bound is the same for closed, Neumann and Dirichlet problems on a connected surface; it needs all
    modes from the first on. Where values coincide, i is the first of the cluster.
    """
    return np.flatnonzero(np.asarray(counts) > np.arange(1, len(counts) + 1))


def _check(graph: NodalGraph, vectors: Floats) -> None:
    if len(graph.starts) != len(vectors) + 1:
        raise ValueError(f"the functions have {len(vectors)} rows, the graph has {len(graph.starts) - 1} nodes")


@njit(cache=True, nogil=True)
def _count(
    order: Integers, starts: Integers, earlier: Integers, columns: Floats, saddles: Floats, peaks: Floats
) -> Integers:
    """Pieces grow as the sweep passes: a node joins those of its earlier neighbours of its sign, which become one."""
    n = columns.shape[1]
    result = np.zeros(len(columns), np.int64)
    sign, label, parent, top = np.empty(n, np.int8), np.empty(n, np.int32), np.empty(n, np.int32), np.empty(n)
    for c in range(len(columns)):
        pieces = np.int32(0)
        for place in range(n):
            value = columns[c, order[place]]
            height = abs(value)
            sign[place] = 0 if height < saddles[c] or value == 0.0 else (1 if value > 0.0 else -1)
            if sign[place] == 0:
                continue
            own = np.int32(-1)
            for p in range(starts[place], starts[place + 1]):
                if sign[earlier[p]] != sign[place] or label[earlier[p]] == own:
                    continue
                other = label[earlier[p]]
                while parent[other] != other:
                    other = parent[other]
                if own >= 0 and other != own:
                    own, other = min(own, other), max(own, other)
                    parent[other] = own
                    top[own] = max(top[own], top[other])
                else:
                    own = other
            if own < 0:
                own, pieces = pieces, pieces + np.int32(1)
                parent[own], top[own] = own, 0.0
            label[place] = own
            top[own] = max(top[own], height)
        for piece in range(pieces):
            result[c] += parent[piece] == piece and top[piece] >= peaks[c]
    return result
