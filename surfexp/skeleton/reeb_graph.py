"""The Reeb graph of a function, sampled at levels: contours and the slab components between them, caps included."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from surfexp.mesh.triangle_mesh import Floats, Integers, TriangleMesh
from surfexp.skeleton.contour_geometry import representatives
from surfexp.skeleton.level_contours import LevelContours, level_contours
from surfexp.skeleton.skeleton import CAP, CONTOUR, JUNCTION, Skeleton, graph_metrics


@dataclass(frozen=True, eq=False)
class Slabs:
    """What lies between the contours.

    Parameters
    ----------
    vertex_component : (n,) int64
        The connected component of {level s - 1 <= f < level s} that each vertex lies in.
    below, above : (C,) int64
        The components on the two sides of each contour.
    count : int
        Number of components; one without a vertex is counted too.
    """

    vertex_component: Integers
    below: Integers
    above: Integers
    count: int


def reeb_graph(mesh: TriangleMesh, values: Floats, levels: Floats, name: str = "surface") -> Skeleton:
    """The Reeb graph of a piecewise linear function (section 5.2), sampled at levels.

    Two contours are joined if one component of the slab between their levels touches both; where more than two do, or where
    the slab ends in an extremum, the component itself becomes a node, a junction or a cap. (The printed rule joins contours
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
        Metrics: contours, nodes, components, b1, leaves, branch_nodes, chain, levels; on a closed surface "hidden_handles", its
        genus less b1: handles whose two saddles no level separates.

    Raises
    ------
    ValueError
        If values or levels are unfit, or the mesh is no manifold.
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
    positions, hub_values, kinds = _hubs(mesh, np.asarray(values, float), contours, slabs, middles, hubs, lower + upper)
    extra = len(hubs)
    metrics = graph_metrics(arcs, count + extra)
    metrics |= {"levels": float(len(contours.levels)), "contours": float(count)}
    notes: tuple[str, ...] = ()
    if not contours.boundary_sides:
        euler_characteristic = len(np.unique(mesh.faces)) - len(mesh.faces) // 2
        genus = int(metrics["components"]) - euler_characteristic // 2
        hidden = genus - int(metrics["b1"])
        metrics["hidden_handles"] = float(hidden)
        if hidden:
            notes = (f"{hidden} of {genus} handles have no level between their two saddles: take more levels.",)
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


def slab_components(mesh: TriangleMesh, contours: LevelContours) -> Slabs:
    """Connected components of the slabs between levels, in time linear in the crossed faces.

    Within a slab, neighbouring pieces of faces share a vertex or a crossing of a contour; so vertices and the two sides of
    every contour are joined, face by face, and no piece is ever made.
    """
    n, count = len(mesh.vertices), len(contours.level)
    roots = _join(mesh.faces, contours.vertex_slabs, contours.face_starts, contours.face_contours, count)
    used = np.zeros(n, dtype=bool)
    used[mesh.faces] = True
    member = np.concatenate([np.flatnonzero(used), np.arange(n, n + 2 * count)])
    found, labels = np.unique(roots[member], return_inverse=True)
    component = np.full(len(roots), -1, dtype=np.int64)
    component[member] = labels.ravel()
    return Slabs(component[:n], component[n : n + count], component[n + count :], len(found))


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


def _hubs(
    mesh: TriangleMesh,
    values: Floats,
    contours: LevelContours,
    slabs: Slabs,
    middles: Floats,
    hubs: Integers,
    degrees: Integers,
) -> tuple[Floats, Floats, Integers]:
    """Positions, values and kinds of components that are nodes.

    A cap sits at its extremal vertex; a junction at the mean of the contours that it joins, with the mean of their levels. A
    whole component of the surface that no level cuts sits at the centroid of its vertices.
    """
    positions, hub_values = np.zeros((slabs.count, 3)), np.zeros(slabs.count)
    for side in (slabs.below, slabs.above):
        np.add.at(positions, side, middles)
        np.add.at(hub_values, side, contours.levels[contours.level])
    positions /= np.maximum(degrees, 1)[:, None]
    hub_values /= np.maximum(degrees, 1)
    kinds = np.where(degrees > 1, JUNCTION, CAP)
    # of a cap below its contour the lowest vertex, of one above it the highest
    sign = np.ones(slabs.count)
    sign[slabs.below] = -1.0
    order = np.argsort(values, kind="stable")
    order = order[slabs.vertex_component[order] >= 0]
    highest, lowest = np.zeros(slabs.count, dtype=np.int64), np.zeros(slabs.count, dtype=np.int64)
    highest[slabs.vertex_component[order]] = order
    lowest[slabs.vertex_component[order[::-1]]] = order[::-1]
    caps = hubs[degrees[hubs] <= 1]
    extremal = np.where(sign > 0, highest, lowest)[caps]
    positions[caps], hub_values[caps] = mesh.vertices[extremal], values[extremal]
    return positions[hubs], hub_values[hubs], kinds[hubs]


@njit(cache=True, nogil=True)
def _find(parents: Integers, i: int) -> int:
    while parents[i] != i:
        parents[i] = parents[parents[i]]
        i = parents[i]
    return i


@njit(cache=True, nogil=True)
def _join(
    faces: Integers, slabs: Integers, face_starts: Integers, face_contours: Integers, contour_count: int
) -> Integers:
    """Roots of vertices, then of the lower sides of the contours, then of their upper sides."""
    n = len(slabs)
    parents = np.arange(n + 2 * contour_count)
    for f in range(len(faces)):
        low = min(slabs[faces[f, 0]], slabs[faces[f, 1]], slabs[faces[f, 2]])
        crossings = face_starts[f + 1] - face_starts[f]
        for s in range(crossings + 1):
            first = -1
            for member in range(5):
                if member < 3:
                    item = faces[f, member] if slabs[faces[f, member]] == low + s else -1
                elif member == 3:
                    # the slab lies above its lower contour and below its upper one
                    item = n + contour_count + face_contours[face_starts[f] + s - 1] if s > 0 else -1
                else:
                    item = n + face_contours[face_starts[f] + s] if s < crossings else -1
                if item < 0:
                    continue
                root = _find(parents, item)
                if first < 0:
                    first = root
                elif root != first:
                    a, b = min(root, first), max(root, first)
                    parents[b] = a
                    first = a
    for i in range(len(parents)):
        parents[i] = _find(parents, i)
    return parents
