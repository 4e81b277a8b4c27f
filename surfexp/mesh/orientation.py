"""Orientation of triangles and fans of triangles around vertices, on meshes that may not be manifold."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import breadth_first_order, connected_components

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.union_find import join, numbered_sets

Mask = NDArray[np.bool_]


def inconsistent_edges(mesh: TriangleMesh) -> Mask:
    """(e,) the edges with two faces that both run through them in the same direction."""
    forward = mesh.faces < mesh.faces[:, [1, 2, 0]]
    runs = np.bincount(mesh.face_edges.ravel(), forward.ravel(), len(mesh.edges))
    return (mesh.edge_face_counts == 2) & (runs != 1)


def flipped_faces(mesh: TriangleMesh) -> Mask:
    """(m,) the smaller part of each edge-connected patch that has to be turned over to orient the patch.

    Patches end at non-manifold edges. On a patch that cannot be oriented some inconsistent edges remain afterwards.
    """
    if not len(mesh.faces):
        return np.zeros(0, dtype=bool)
    count = len(mesh.faces)
    _, _, half_edges, starts = mesh.edge_table
    shared = starts[:-1][np.diff(starts) == 2]
    one, other = half_edges[shared], half_edges[shared + 1]
    first = mesh.faces.ravel()
    # two faces run through their edge from the same vertex where one of them has to be turned
    unlike = first[one] == first[other]
    pairs = np.concatenate([np.stack([one, other]), np.stack([other, one])], axis=1) // 3
    neighbours = csr_array((np.ones(pairs.shape[1], np.int8), pairs), shape=(count, count))
    patch = connected_components(neighbours, directed=False)[1]
    seeds = np.unique(patch, return_index=True)[1]
    # one search of all patches, from a root that leads to the first face of each
    rows, columns = np.append(pairs[0], np.full(len(seeds), count)), np.append(pairs[1], seeds)
    graph = csr_array((np.ones(len(rows), np.int8), (rows, columns)), shape=(count + 1, count + 1))
    before = breadth_first_order(graph, count)[1][:count].astype(np.int64)
    turned = np.zeros(count, dtype=bool)
    steps = before[pairs[1]] == pairs[0]
    turned[pairs[1][steps]] = np.tile(unlike, 2)[steps]
    # what the whole path to the first face says, twice as far each time; a first face is its own and is not turned
    above = np.where(before < count, before, np.arange(count))
    while (above != above[above]).any():
        turned = turned ^ turned[above]
        above = above[above]
    share = np.bincount(patch, turned) / np.bincount(patch)
    return np.asarray(turned != (share > 0.5)[patch])


def turn_over(faces: Integers, chosen: Mask) -> Integers:
    """The faces, those chosen with the opposite orientation."""
    return np.where(chosen[:, None], faces[:, [0, 2, 1]], faces)


def corner_fans(mesh: TriangleMesh, crossable: Mask) -> Integers:
    """(m, 3) number of the fan of faces to which each corner belongs, from 0.

    Two corners at one vertex are in one fan when the faces between them are joined by `crossable` edges (e,).
    """
    _, _, half_edges, starts = mesh.edge_table
    return np.asarray(_corner_fans(mesh.faces, half_edges, starts, crossable)).reshape(-1, 3)


@njit(cache=True, nogil=True)
def _corner_fans(faces: Integers, half_edges: Integers, starts: Integers, crossable: Mask) -> Integers:
    parents = np.arange(faces.size)
    for edge in np.flatnonzero(crossable):
        for i in range(starts[edge] + 1, starts[edge + 1]):
            f, k = divmod(half_edges[i - 1], 3)
            g, side = divmod(half_edges[i], 3)
            for corner in (k, (k + 1) % 3):
                # a half-edge of the other face may run the other way
                other = side if faces[g, side] == faces[f, corner] else (side + 1) % 3
                join(parents, 3 * f + corner, 3 * g + other)
    return numbered_sets(parents)


def fans_per_vertex(mesh: TriangleMesh, fans: Integers) -> Integers:
    """(n,) number of fans at each vertex: 1 where the surface is a manifold or has a boundary, 0 where no face is."""
    owner = np.empty(fans.max(initial=-1) + 1, dtype=np.int64)
    owner[fans.ravel()] = mesh.faces.ravel()
    return np.bincount(owner, minlength=len(mesh.vertices))


def inside_out_components(mesh: TriangleMesh) -> Mask:
    """(m,) faces of closed, consistently oriented components inside of which the winding number is negative.

    A component that is oriented inward inside of one that is oriented outward bounds a cavity, and is sound. Where the
    outer one is inside out, components inside that are oriented against it are turned over with it.
    """
    label = mesh.component_labels[mesh.faces[:, 0]]
    count = mesh.component_labels.max(initial=-1) + 1
    defects = (mesh.edge_face_counts != 2) | inconsistent_edges(mesh)
    closed = np.bincount(label, defects[mesh.face_edges].any(axis=1), count) == 0
    used = np.zeros(len(mesh.vertices), dtype=bool)
    used[mesh.faces] = True
    middle = mesh.vertices[used].mean(axis=0)
    shares = ((mesh.vertices[mesh.faces[:, 0]] - middle) * mesh.face_cross_products).sum(axis=1)
    volumes = np.where(closed, np.bincount(label, shares, count), 0.0)
    turned = volumes < 0
    if not turned.any() or (volumes != 0).sum() == 1:
        return np.asarray(turned[label])
    around = _enclosing(mesh, label, volumes)
    signs, turned = np.sign(volumes).astype(np.int64), np.zeros(count, dtype=bool)
    for component in np.argsort(-np.abs(volumes), kind="stable").tolist():
        outer = around[component]
        parent = min(outer, key=lambda k: abs(volumes[k]), default=-1)
        sign = int(np.sign(volumes[component]))
        follows = parent >= 0 and turned[parent] and sign == -int(np.sign(volumes[parent]))
        winding = int(signs[outer].sum()) + (-sign if follows else sign)
        turned[component] = (follows and winding >= 0) or (not follows and sign < 0 and winding < 0)
        signs[component] = -sign if turned[component] else sign
    return np.asarray(turned[label])


def _enclosing(mesh: TriangleMesh, label: Integers, volumes: Floats) -> list[list[int]]:
    """Return the closed components that enclose each closed component."""
    count = len(volumes)
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    corner = label.repeat(3)
    np.minimum.at(low, corner, mesh.vertices[mesh.faces.ravel()])
    np.maximum.at(high, corner, mesh.vertices[mesh.faces.ravel()])
    first = np.full(count, -1)
    first[label[::-1]] = mesh.faces[::-1, 0]
    around: list[list[int]] = [[] for _ in range(count)]
    for outer in np.flatnonzero(volumes).tolist():
        within = (low > low[outer]).all(axis=1) & (high < high[outer]).all(axis=1) & (volumes != 0)
        inner = np.flatnonzero(within)
        if len(inner):
            faces = np.ascontiguousarray(mesh.faces[label == outer])
            for component in inner.tolist():
                if abs(winding_number(mesh.vertices[faces], mesh.vertices[first[component]])) > 0.5:
                    around[component].append(outer)
    return around


def winding_number(corners: Floats, point: Floats) -> float:
    """Sum of the signed solid angles of triangles (m, 3, 3) seen from a point, over 4 pi (van Oosterom, Strackee 1983)."""
    a, b, c = (corners - point).transpose(1, 0, 2)
    sizes = [np.linalg.norm(side, axis=1) for side in (a, b, c)]
    volume = np.einsum("mi,mi->m", a, np.cross(b, c))
    ab, bc, ca = (np.einsum("mi,mi->m", *pair) for pair in ((a, b), (b, c), (c, a)))
    base = sizes[0] * sizes[1] * sizes[2] + ab * sizes[2] + bc * sizes[0] + ca * sizes[1]
    return float(np.arctan2(volume, base).sum() / (2.0 * np.pi))
