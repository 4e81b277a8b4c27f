"""Handles that a choice of levels cannot see, named one by one from the exact Reeb graph."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from surfexp.contract.arrays import Floats
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.skeleton.exact_reeb_graph import exact_reeb_graph


@dataclass(frozen=True)
class HiddenHandles:
    """Loops of the exact graph that lie between two neighbouring levels.

    Parameters
    ----------
    slab : int
        How many levels lie below.
    handles : int
    low, high : float
        Values of the lowest and the highest saddle of the loops: no level lies between.
    """

    slab: int
    handles: int
    low: float
    high: float

    def __str__(self) -> str:
        what = "1 handle" if self.handles == 1 else f"{self.handles} handles"
        return f"{what} with saddles from {self.low:.4g} to {self.high:.4g}"


def hidden_handles(mesh: TriangleMesh, values: Floats, levels: Floats) -> tuple[HiddenHandles, ...]:
    """Find every group of handles that no level separates, by rising value.

    Loops of a sampled graph and these handles together are the loops of the exact graph.

    Parameters
    ----------
    mesh : TriangleMesh
    values : (n,) float64
    levels : (K,) float64
        Increasing; a vertex at a level counts as above it.

    Raises
    ------
    ValueError
        If the values are unfit.
    """
    graph = exact_reeb_graph(mesh, values)
    slab = np.searchsorted(levels, graph.values, side="right")
    count = len(graph.vertices)
    inner = graph.arcs[slab[graph.arcs[:, 0]] == slab[graph.arcs[:, 1]]]
    while True:
        # an arc that ends where no other does is in no loop
        lonely = np.bincount(inner.ravel(), minlength=count) == 1
        kept = ~lonely[inner].any(axis=1)
        if kept.all():
            break
        inner = inner[kept]
    matrix = coo_array((np.ones(len(inner)), (inner[:, 0], inner[:, 1])), shape=(count, count))
    label = connected_components(matrix, directed=False)[1]
    found = []
    for piece in np.unique(label[inner[:, 0]]):
        nodes = np.flatnonzero(label == piece)
        loops = int((label[inner[:, 0]] == piece).sum()) - len(nodes) + 1
        low, high = float(graph.values[nodes].min()), float(graph.values[nodes].max())
        found.append(HiddenHandles(int(slab[nodes[0]]), loops, low, high))
    return tuple(sorted(found, key=lambda item: (item.low, item.high)))
