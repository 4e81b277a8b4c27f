"""A surface of any genus cut into disks, each mapped to the plane and solved on its own."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import dijkstra

from surfexp.baselines.disk_map import disk_map
from surfexp.baselines.distortion import distortion
from surfexp.baselines.parameter_domain import ParameterDomain, conformal_operator, image_mesh
from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.edge_table import half_edge_table
from surfexp.mesh.triangle_mesh import TriangleMesh


def disk_patches(mesh: TriangleMesh, count: int) -> Integers:
    """Cut a surface into topological disks, cells of faces nearest to seeds that lie far from one another.

    A cell that is no disk is halved until all are.

    Parameters
    ----------
    mesh : TriangleMesh
    count : int
        Number of cells to begin with.

    Returns
    -------
    (m,) int64
        Number of the patch of each face, from 0 without gaps.

    Raises
    ------
    ValueError
        If count is not between 1 and the number of faces.
    """
    if not 1 <= count <= len(mesh.faces):
        raise ValueError(f"number of patches is {count}, must lie between 1 and the {len(mesh.faces)} faces")
    graph = _face_graph(mesh)
    labels = _nearest_seed(graph, count)
    waiting = list(range(labels.max() + 1))
    while waiting:
        label = waiting.pop()
        members = np.flatnonzero(labels == label)
        if _euler_characteristic(mesh.faces[members]) != 1:
            halves = _nearest_seed(graph[members][:, members], 2)
            labels[members[halves == 1]] = labels.max() + 1
            waiting += [label, int(labels.max())]
    return labels


def patchwise_domain(mesh: TriangleMesh, labels: Integers) -> ParameterDomain:
    """Map every patch to the plane and take the planes together, unconnected, as one parameter domain.

    A vertex on a seam has a copy in every patch; its result is the mean of the copies by area. No patch knows of its
    neighbours, so the problem on the domain is that of each patch on its own, with a Neumann boundary at the seams.

    Parameters
    ----------
    mesh : TriangleMesh
    labels : (m,) int64
        Patch of each face, every patch a disk, as from `disk_patches`.

    Raises
    ------
    ValueError
        If a patch is not a topological disk.
    """
    copies, corner = np.unique(np.repeat(labels, 3) * len(mesh.vertices) + mesh.faces.ravel(), return_inverse=True)
    origin, patch = copies % len(mesh.vertices), copies // len(mesh.vertices)
    cut = TriangleMesh(mesh.vertices[origin], corner.reshape(-1, 3))
    positions = np.zeros((len(origin), 2))
    for label in range(int(labels.max()) + 1):
        members = np.flatnonzero(patch == label)
        faces = np.searchsorted(members, cut.faces[labels == label])
        positions[members] = disk_map(TriangleMesh(cut.vertices[members], faces))
    image = image_mesh(cut, positions)
    operator = conformal_operator(cut, image)
    shape = (len(origin), len(mesh.vertices))
    to_domain = csr_array((np.ones(len(origin)), (np.arange(len(origin)), origin)), shape=shape)
    total = np.bincount(origin, operator.mass, shape[1])
    to_vertices = csr_array((operator.mass / total[origin], (origin, np.arange(len(origin)))), shape=shape[::-1])
    metrics = distortion(cut, image) | {
        "patches": float(labels.max() + 1),
        "seam_vertices": float(seam_vertices(mesh, labels).sum()),
    }
    return ParameterDomain(operator, to_domain, to_vertices, name="patchwise", metrics=metrics)


def seam_vertices(mesh: TriangleMesh, labels: Integers) -> np.ndarray:
    """(n,) bool, vertices that belong to several patches."""
    lowest = np.full(len(mesh.vertices), len(mesh.faces))
    highest = np.full(len(mesh.vertices), -1)
    np.minimum.at(lowest, mesh.faces, labels[:, None])
    np.maximum.at(highest, mesh.faces, labels[:, None])
    return lowest < highest


def seam_error(mesh: TriangleMesh, labels: Integers, values: Floats, reference: Floats) -> dict[str, float]:
    """Compare a patchwise result with a reference on the seams and away from them.

    Returns
    -------
    dict
        seam_error, interior_error : area-weighted mean of |values - reference| on seam vertices and over all others;
        seam_error_share : part of the whole error that the seam vertices and their neighbours carry;
        seam_area_share : part of the area that they have.
    """
    on_seam = seam_vertices(mesh, labels)
    error, mass = np.abs(values - reference), mesh.vertex_areas
    near = on_seam.copy()
    near[mesh.faces[on_seam[mesh.faces].any(axis=1)]] = True
    total = max(float(mass @ error), 1e-300)
    return {
        "seam_error": float(mass[on_seam] @ error[on_seam] / max(mass[on_seam].sum(), 1e-300)),
        "interior_error": float(mass[~on_seam] @ error[~on_seam] / max(mass[~on_seam].sum(), 1e-300)),
        "seam_error_share": float(mass[near] @ error[near] / total),
        "seam_area_share": float(mass[near].sum() / mass.sum()),
    }


def _face_graph(mesh: TriangleMesh) -> csr_array:
    """Adjacent faces with the distance of their centroids."""
    order = mesh.edge_table.half_edges
    edge, face = mesh.edge_table.edge_of[order], order // 3
    pair = edge[1:] == edge[:-1]
    a, b = face[:-1][pair], face[1:][pair]
    centroids = mesh.vertices[mesh.faces].mean(axis=1)
    length = np.linalg.norm(centroids[a] - centroids[b], axis=1)
    count = len(mesh.faces)
    graph = coo_array((np.tile(length, 2), (np.append(a, b), np.append(b, a))), shape=(count, count))
    return csr_array(graph)


def _nearest_seed(graph: csr_array, count: int) -> Integers:
    """Cells of `count` nodes, each farthest from those before it; a part without a seed gets one of its own."""
    distance = dijkstra(graph, indices=0)
    distance[np.isinf(distance)] = 0.0
    seeds = [int(np.argmax(distance))]
    nearest = dijkstra(graph, indices=seeds[0])
    while len(seeds) < count or np.isinf(nearest).any():
        seeds.append(int(np.argmax(nearest)))
        nearest = np.minimum(nearest, dijkstra(graph, indices=seeds[-1]))
    _, _, source = dijkstra(graph, indices=seeds, min_only=True, return_predecessors=True)
    return np.searchsorted(np.sort(seeds), source)


def _euler_characteristic(faces: Integers) -> int:
    vertices = np.bincount(faces.ravel())
    return int(np.count_nonzero(vertices)) - len(half_edge_table(faces, len(vertices)).edges) + len(faces)
