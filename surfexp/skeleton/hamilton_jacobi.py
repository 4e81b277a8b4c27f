"""The Hamilton-Jacobi skeleton: thinning from the boundary inward that keeps topology and ends of strong flux."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.vertex_star import vertex_stars
from surfexp.skeleton.adjacency import opposite_sides
from surfexp.skeleton.boundary_distance import boundary_vertices
from surfexp.skeleton.flux import flux
from surfexp.skeleton.skeleton import CAP, CONTOUR, JUNCTION, Skeleton, graph_metrics


def hamilton_jacobi_skeleton(
    mesh: TriangleMesh, distance: Floats, threshold: float = -0.35, name: str = "surface"
) -> Skeleton:
    """Remove vertices in the order of their distance while the rest stays homotopy equivalent (Siddiqi et al. 2002).

    A vertex whose remaining neighbours in its link form one path may go; the end of a curve stays if its flux (5.9) is
    below the threshold.

    Parameters
    ----------
    mesh : TriangleMesh
        With a boundary.
    distance : (n,) float64
        To the boundary (5.6).
    threshold : float
        Negative; the nearer to 0, the more branches.

    Returns
    -------
    Skeleton
        Its nodes are mesh vertices and its arcs mesh edges; `values` is the distance. Metrics as in `reeb_graph`.

    Raises
    ------
    ValueError
        If the surface is closed, the threshold not negative or the distance unfit.
    """
    boundary_vertices(mesh)
    if not threshold < 0:
        raise ValueError(f"flux threshold is {threshold}, it must be negative; -0.35 is a usual choice")
    if np.shape(distance) != (len(mesh.vertices),) or not np.isfinite(distance).all():
        raise ValueError(f"the distance has shape {np.shape(distance)}; {len(mesh.vertices)} finite values are needed")
    n = len(mesh.vertices)
    start, star = vertex_stars(mesh.faces, n)
    strong = flux(mesh, distance) < threshold
    order = np.argsort(distance, kind="stable")
    kept = _thin(mesh.faces, opposite_sides(mesh), start, star, order, strong)
    kept &= np.bincount(mesh.faces.ravel(), minlength=n) > 0
    number = np.cumsum(kept) - 1
    arcs = _spanning_edges(mesh, kept, number)
    nodes = np.flatnonzero(kept)
    degrees = np.bincount(arcs.ravel(), minlength=len(nodes))
    kinds = np.where(degrees == 1, CAP, np.where(degrees > 2, JUNCTION, CONTOUR))
    swap = distance[nodes[arcs[:, 0]]] > distance[nodes[arcs[:, 1]]]
    arcs = np.where(swap[:, None], arcs[:, ::-1], arcs)
    metrics = graph_metrics(arcs, len(nodes))
    sizes = np.linalg.norm(mesh.vertices[nodes[arcs[:, 1]]] - mesh.vertices[nodes[arcs[:, 0]]], axis=1)
    return Skeleton(
        positions=mesh.vertices[nodes],
        kinds=kinds.astype(np.int64),
        values=distance[nodes],
        lengths=np.zeros(len(nodes)),
        closed=np.zeros(len(nodes), dtype=bool),
        level_index=np.full(len(nodes), -1, dtype=np.int64),
        arcs=arcs.astype(np.int64),
        levels=np.zeros(0),
        contour_points=np.zeros((0, 3)),
        contour_starts=np.zeros(len(nodes) + 1, dtype=np.int64),
        name=name,
        method="hamilton jacobi",
        metrics={**metrics, "length": float(sizes.sum())},
    )


def _spanning_edges(mesh: TriangleMesh, kept: np.ndarray, number: Integers) -> Integers:
    """Edges among kept vertices, less the longest side of any face that is kept as a whole, so that b1 is right."""
    edges = mesh.edges[kept[mesh.edges].all(axis=1)]
    whole = mesh.faces[kept[mesh.faces].all(axis=1)]
    dropped = set()
    for face in whole.tolist():
        sides = [tuple(sorted((face[k], face[(k + 1) % 3]))) for k in range(3)]
        left = [side for side in sides if side not in dropped]
        dropped.add(max(left, key=lambda side: float(np.linalg.norm(mesh.vertices[side[0]] - mesh.vertices[side[1]]))))
    remaining = [edge for edge in edges.tolist() if tuple(edge) not in dropped]
    return number[np.array(remaining, dtype=np.int64).reshape(-1, 2)]


@njit(cache=True, nogil=True)
def _thin(
    faces: Integers, twins: Integers, start: Integers, star: Integers, order: Integers, strong: np.ndarray
) -> np.ndarray:
    kept = np.ones(len(order), np.bool_)
    changed = True
    while changed:
        changed = False
        for v in order:
            if not kept[v]:
                continue
            # Euler characteristic of the kept part of the link, twice: a path has 1, a ring 0
            link, neighbours = 0, 0
            for at in range(start[v], start[v + 1]):
                f = star[at]
                inside = 0
                for k in range(3):
                    a, b = faces[f, k], faces[f, (k + 1) % 3]
                    if a != v and b != v:
                        inside = (1 if kept[a] else 0) + (1 if kept[b] else 0)
                    elif kept[a + b - v]:
                        neighbours += 2 if twins[3 * f + k] < 0 else 1
                if inside == 2:
                    link -= 2
            link += neighbours
            if link == 2 and (neighbours > 2 or not strong[v]):
                kept[v] = False
                changed = True
    return kept
