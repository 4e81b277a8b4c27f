"""The Reeb graph of a function, sampled at levels: contours and the slab components between them, caps included."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.skeleton.contour_geometry import representatives
from surfexp.skeleton.contour_junctions import hub_nodes
from surfexp.skeleton.hidden_handles import hidden_handles
from surfexp.skeleton.interlevel_components import Slabs, slab_components
from surfexp.skeleton.level_contours import level_contours
from surfexp.skeleton.skeleton import CONTOUR, Skeleton, graph_metrics


def reeb_graph(mesh: TriangleMesh, values: Floats, levels: Floats, name: str = "surface") -> Skeleton:
    """The Reeb graph of a piecewise linear function (section 5.2), sampled at levels.

    Two contours are joined if one component of the slab between their levels touches both; where more than two do, or where
    the slab ends in an extremum, the component itself becomes a node, a junction or a cap. (The published rule joins contours
    pairwise, which makes a loop of each saddle, and leaves the caps out.)

    Parameters
    ----------
    mesh : TriangleMesh
    values : (n,) float64
        A vertex at a level counts as above it.
    levels : (K,) float64
        Increasing.

    Returns
    -------
    Skeleton
        Metrics: contours, nodes, components, b1, leaves, branch_nodes, chain, levels; on a closed surface "hidden_handles",
        loops of the exact graph whose two saddles no level separates (with b1 they make the genus of a manifold). A note then
        names their saddles.

    Raises
    ------
    ValueError
        If values or levels are unfit, or an edge has three faces.
    """
    contours = level_contours(mesh, values, levels)
    slabs = slab_components(mesh, contours)
    middles, lengths = representatives(contours, mesh.vertices)
    count = len(contours.level)
    # a component with one contour on either side is no node: the two are joined
    lower, upper = np.bincount(slabs.above, minlength=slabs.count), np.bincount(slabs.below, minlength=slabs.count)
    passing = (lower == 1) & (upper == 1)
    node_of = np.where(passing, -1, count + np.cumsum(~passing) - 1)
    hubs = np.flatnonzero(~passing)
    arcs = _arcs(slabs, node_of, passing, count)
    values = np.asarray(values, dtype=np.float64)
    positions, hub_values, kinds = hub_nodes(mesh, values, contours, slabs, middles, hubs)
    extra = len(hubs)
    metrics = graph_metrics(arcs, count + extra)
    metrics |= {"levels": float(len(contours.levels)), "contours": float(count)}
    notes: tuple[str, ...] = ()
    if not contours.boundary_sides:
        hidden = hidden_handles(mesh, values, contours.levels)
        count_hidden = sum(item.handles for item in hidden)
        metrics["hidden_handles"] = float(count_hidden)
        if hidden:
            handles, named = int(metrics["b1"]) + count_hidden, ", ".join(map(str, hidden))
            notes = (
                f"{count_hidden} of {handles} handles have no level between their saddles ({named}): "
                "take critical levels.",
            )
    return Skeleton(
        positions=np.concatenate([middles, positions]),
        kinds=np.concatenate([np.full(count, CONTOUR), kinds]).astype(np.int64),
        values=np.concatenate([contours.levels[contours.level], hub_values]),
        lengths=np.concatenate([lengths, np.zeros(extra)]),
        closed=np.concatenate([contours.closed, np.zeros(extra, dtype=bool)]),
        level_index=np.concatenate([contours.level, np.full(extra, -1)]).astype(np.int64),
        arcs=arcs,
        levels=contours.levels,
        contour_points=contours.interpolate(mesh.vertices),
        contour_starts=np.concatenate([contours.starts, np.full(extra, contours.starts[-1])]).astype(np.int64),
        name=name,
        metrics=metrics,
        notes=notes,
    )


def _arcs(slabs: Slabs, node_of: Integers, passing: np.ndarray, count: int) -> Integers:
    """Arcs from lower to higher nodes: contour to contour through a passing component, else through its hub."""
    contour = np.arange(count)
    under = np.full(slabs.count, -1, dtype=np.int64)
    under[slabs.above] = contour
    through = passing[slabs.below]
    direct = np.stack([under[slabs.below[through]], contour[through]], axis=1)
    rising = np.stack([node_of[slabs.below[~through]], contour[~through]], axis=1)
    ending = ~passing[slabs.above]
    leaving = np.stack([contour[ending], node_of[slabs.above[ending]]], axis=1)
    return np.concatenate([direct, rising, leaving]).astype(np.int64)
