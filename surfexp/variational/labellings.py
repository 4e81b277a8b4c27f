"""Two-phase labellings of the vertices: their energy, and the best threshold of a field."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats, Integers
from surfexp.operators.surface_operator import SurfaceOperator

Mask = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class EdgeCut:
    """The total variation of labellings as a cut of weighted edges: TV(1_S) = sum of c_ij over the edges that leave S.

    TV(1_S) is the piecewise linear total variation of the field that is 1 on the vertices of S and 0 elsewhere, hence that
    of every certificate here, and also the length of the polygon that crosses the cut edges at their midpoints. In a face
    with the opposite edges a, b, c the edge of length a has the weight (b + c - a) / 4, which is never negative.

    Parameters
    ----------
    edges : (e, 2) int64
    weights : (e,) float64
    vertex_count : int
    """

    edges: Integers
    weights: Floats
    vertex_count: int

    def perimeter(self, region: Mask) -> float:
        """Return TV(1_S) of the vertices where `region` is True."""
        return float(self.weights @ (region[self.edges[:, 0]] != region[self.edges[:, 1]]))

    def perimeters_above(self, values: Floats) -> tuple[Floats, Floats]:
        """Return the distinct values t, ascending, and TV(1_S) of S = {values > t} for each, by one sweep over the edges."""
        levels, rank = np.unique(values, return_inverse=True)
        ends = rank[self.edges]
        change = np.bincount(ends.min(axis=1), self.weights, len(levels)).astype(np.float64)
        change -= np.bincount(ends.max(axis=1), self.weights, len(levels))
        perimeters = np.cumsum(change)
        perimeters[-1] = 0.0
        return levels, perimeters


def edge_cut(operator: SurfaceOperator) -> EdgeCut:
    """Return the edge weights by which an operator measures the boundary of a labelling."""
    opposite = operator.areas[:, None] * np.linalg.norm(operator.hat_gradients, axis=2)
    corner = 0.5 * opposite.sum(axis=1, keepdims=True) - opposite
    pairs = np.sort(operator.faces[:, [1, 2, 2, 0, 0, 1]].reshape(-1, 2), axis=1)
    keys, place = np.unique(pairs[:, 0] * operator.vertex_count + pairs[:, 1], return_inverse=True)
    edges = np.stack(np.divmod(keys, operator.vertex_count), axis=1)
    weights = np.bincount(place, corner.ravel(), len(keys)).astype(np.float64)
    return EdgeCut(edges, weights, operator.vertex_count)


@dataclass(frozen=True, eq=False)
class Labelling:
    """The vertices where a field exceeds a threshold, and the energy of their indicator.

    Parameters
    ----------
    name : str
        What it is: "the empty field", "the full field" or "a threshold of ...".
    region : (n,) bool
    threshold : float
        region = field > threshold.
    energy : float
        TV(1_S) + sum of m_i r_i over S.
    """

    name: str
    region: Mask
    threshold: float
    energy: float


def best_threshold(cut: EdgeCut, mass: Floats, slope: Floats, values: Floats, of: str) -> Labelling:
    """Return the labelling {values > t} of least energy over every t, the empty and the full one among them.

    Parameters
    ----------
    cut : EdgeCut
    mass, slope : (n,) float64
        m and r of the energy TV(phi) + sum_i m_i r_i phi_i.
    values : (n,) float64
        The field that is cut off: phi, or the image.
    of : str
        What the field is called.
    """
    levels, perimeters = cut.perimeters_above(values)
    data = np.bincount(np.searchsorted(levels, values), mass * slope, len(levels))
    energies = perimeters + data[::-1].cumsum()[::-1] - data
    full = float(data.sum())
    best = int(np.argmin(energies))
    if full < energies[best]:
        below = float(levels[0] - max(1.0, abs(levels[0])))
        return Labelling("the full field", np.ones(len(values), dtype=bool), below, full)
    level = float(levels[best])
    if best == len(levels) - 1:
        return Labelling("the empty field", np.zeros(len(values), dtype=bool), level, 0.0)
    middle = 0.5 * (level + float(levels[best + 1]))
    threshold = middle if middle < levels[best + 1] else level
    return Labelling(f"a threshold of {of}", values > level, threshold, float(energies[best]))
