"""A skeleton: a graph in space whose nodes are contours of a feature function and what joins them."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats, Integers
from surfexp.contract.drawable import Drawable
from surfexp.contract.metric import Metric
from surfexp.contract.summary import Summary
from surfexp.skeleton.radii import branch_table, contour_radii

if TYPE_CHECKING:
    import networkx

CONTOUR, CAP, JUNCTION = 0, 1, 2
KINDS = ("contour", "cap", "junction")


@dataclass(frozen=True, eq=False, repr=False)
class Skeleton(Drawable):
    """A graph in space.

    Parameters
    ----------
    positions : (N, 3) float64
    kinds : (N,) int64
        0 contour, 1 cap (an extremum beyond the last contour), 2 junction (contours that meet in one slab). In a skeleton
        without contours, the end points are caps and the branch points junctions.
    values : (N,) float64
        The feature at the node.
    lengths : (N,) float64
        Length of the contour, 0 at caps and junctions.
    closed : (N,) bool
        Whether the contour is a closed curve.
    level_index : (N,) int64
        Index into `levels`, -1 at caps and junctions.
    arcs : (A, 2) int64
        Node pairs, from the lower to the higher value.
    levels : (K,) float64
        The sampled values, increasing; none in a skeleton without contours.
    contour_points : (P, 3) float64
    contour_starts : (N + 1,) int64
        The line of node i is contour_points[contour_starts[i] : contour_starts[i + 1]].
    name, method : str
    metrics : dict of str to float
        As in `Surface`; b1 counts the independent loops.
    notes : tuple of str
    """

    positions: Floats
    kinds: Integers
    values: Floats
    lengths: Floats
    closed: NDArray[np.bool_]
    level_index: Integers
    arcs: Integers
    levels: Floats
    contour_points: Floats
    contour_starts: Integers
    name: str = "skeleton"
    method: str = "reeb graph"
    metrics: dict[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    METRICS: ClassVar[dict[str, Metric]] = {
        "nodes": Metric("nodes of the graph"),
        "components": Metric("connected components"),
        "b1": Metric("independent loops"),
        "leaves": Metric("nodes of degree one"),
        "branch_nodes": Metric("nodes of degree three or more"),
        "chain": Metric("1 where the graph is a chain, else 0"),
    }

    @property
    def degrees(self) -> Integers:
        """(N,) number of arcs at each node."""
        return np.bincount(self.arcs.ravel(), minlength=len(self.positions)).astype(np.int64)

    @cached_property
    def radii(self) -> Floats:
        """(N,) radius at each node.

        Of a contour the mean distance of its points, by length, from the axis: the line through its middle along the skeleton.
        `lengths` over 2 pi is the radius by the surface alone, larger where a contour is aslant. Of a cap it is 0, of a junction
        the mean of the contours next to it. NaN where there is no contour.
        """
        radii = contour_radii(self.positions, self.contour_points, self.contour_starts, self.closed, self.arcs)
        arcs = np.concatenate([self.arcs, self.arcs[:, ::-1]])
        arcs = arcs[np.isfinite(radii[arcs[:, 1]])]
        sums = np.bincount(arcs[:, 0], radii[arcs[:, 1]], len(radii))
        beside = np.bincount(arcs[:, 0], minlength=len(radii))
        around = np.divide(sums, beside, out=np.full(len(radii), np.nan), where=beside > 0)
        radii = np.where((self.kinds == JUNCTION) & np.isnan(radii), around, radii)
        return np.where((self.kinds == CAP) & (len(self.contour_points) > 0), 0.0, radii)

    def branches(self) -> dict[str, list[Any]]:
        """Return the branches between ends and junctions as columns, as pandas.DataFrame takes them.

        Returns
        -------
        dict of str to list
            first, last: nodes. from, to: "cap", "junction" or "contour". nodes: how many. length: through their positions.
            radius, smallest, largest: median and ends of the radii of contours, NaN without one. Contours that meet a boundary are
            part of a ring only.
        """
        return branch_table(self.positions, np.array(KINDS)[self.kinds], self.arcs, self.radii)

    @property
    def is_chain(self) -> bool:
        """Whether the graph is a single path: connected, without loop or branch."""
        return self.metrics["components"] == 1 and self.metrics["b1"] == 0 and int(self.degrees.max(initial=0)) <= 2

    def in_length(self, length: float) -> Skeleton:
        """Return the same skeleton in another unit of length.

        Parameters
        ----------
        length : float
            How many of the other unit are one of the present unit.

        Returns
        -------
        Skeleton
        """
        if length == 1.0:
            return self
        lines = {name: length * getattr(self, name) for name in ("positions", "lengths", "contour_points")}
        return replace(self, **lines)

    def graph(self) -> networkx.Graph:
        """Return the graph in networkx's form.

        Returns
        -------
        networkx.Graph
            Nodes with x, y, z, kind, value, length, closed, level, and the radius where it is known; arcs with their length.
        """
        import networkx

        graph = networkx.Graph(name=self.name, method=self.method)
        for i, (x, y, z) in enumerate(self.positions.tolist()):
            graph.add_node(
                i,
                x=x,
                y=y,
                z=z,
                kind=KINDS[self.kinds[i]],
                value=float(self.values[i]),
                length=float(self.lengths[i]),
                closed=bool(self.closed[i]),
                level=int(self.level_index[i]),
                **({"radius": float(self.radii[i])} if np.isfinite(self.radii[i]) else {}),
            )
        sizes = np.linalg.norm(self.positions[self.arcs[:, 1]] - self.positions[self.arcs[:, 0]], axis=1)
        graph.add_edges_from((a, b, {"length": size}) for (a, b), size in zip(self.arcs.tolist(), sizes, strict=True))
        return graph

    def _summary(self) -> Summary:
        facts = {
            "levels": len(self.levels),
            "loops": int(self.metrics["b1"]),
            "components": int(self.metrics["components"]),
            "branches": int(self.metrics["branch_nodes"]),
            "end points": int(self.metrics["leaves"]),
        }
        return Summary(f"{self.name}, {self.method}", facts, self.notes)


def chain_order(skeleton: Skeleton) -> Integers:
    """Nodes of a chain from its end of lower value to the other.

    Raises
    ------
    ValueError
        If the skeleton is no chain.
    """
    if not skeleton.is_chain:
        loops, leaves = int(skeleton.metrics["b1"]), int(skeleton.metrics["leaves"])
        raise ValueError(f"skeleton {skeleton.name!r} has {leaves} leaves and {loops} loops, a chain has 2 and 0")
    if not len(skeleton.arcs):
        return np.zeros(1, dtype=np.int64)
    neighbours: list[list[int]] = [[] for _ in skeleton.positions]
    for a, b in skeleton.arcs.tolist():
        neighbours[a].append(b)
        neighbours[b].append(a)
    ends = [i for i, around in enumerate(neighbours) if len(around) == 1]
    order, previous = [min(ends, key=lambda i: skeleton.values[i])], -1
    while len(order) < len(neighbours):
        onward = [i for i in neighbours[order[-1]] if i != previous]
        previous = order[-1]
        order.append(onward[0])
    return np.array(order, dtype=np.int64)


def arc_components(arcs: Integers, count: int) -> int:
    """Number of connected components of a graph of `count` nodes."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    graph = coo_array((np.ones(len(arcs)), (arcs[:, 0], arcs[:, 1])), shape=(count, count))
    return int(connected_components(graph, directed=False)[0])


def graph_metrics(arcs: Integers, count: int) -> dict[str, float]:
    """Counts of a graph: nodes, components, b1, leaves, branch_nodes (three arcs or more), chain (1 or 0)."""
    components, degrees = arc_components(arcs, count), np.bincount(arcs.ravel(), minlength=count)
    loops = len(arcs) - count + components
    chain = components == 1 and loops == 0 and degrees.max(initial=0) <= 2
    numbers = {
        "nodes": count,
        "components": components,
        "b1": loops,
        "leaves": int((degrees == 1).sum()),
        "branch_nodes": int((degrees > 2).sum()),
        "chain": int(chain),
    }
    return {name: float(number) for name, number in numbers.items()}
