"""Removal of faces that carry no surface and of faces too many at an edge."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Integers
from surfexp.mesh.equal_rows import later_copies
from surfexp.mesh.thin_faces import zero_area_faces
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.validate import repeated_index_faces


def drop_bad_faces(mesh: TriangleMesh, changes: list[str]) -> Integers:
    """The faces without those that name a vertex twice and without copies; says so in `changes`."""
    repeated = repeated_index_faces(mesh)
    if repeated.any():
        changes.append(f"dropped, because they name a vertex twice: {repeated.sum()} faces")
    faces = mesh.faces[~repeated]
    copies = later_copies(np.sort(faces, axis=1))
    if copies.any():
        changes.append(f"dropped, because they are copies: {copies.sum()} faces")
    return faces[~copies]


def flip_zero_area_faces(mesh: TriangleMesh, changes: list[str]) -> Integers:
    """The faces with those without area merged into their neighbours by flipping their longest side.

    The middle vertex of such a face lies on its longest side, so the flip splits the neighbour there and the surface
    does not change. A face with no single neighbour there, or whose flip would double an edge, is dropped.
    """
    faces, flipped, dropped = np.array(mesh.faces), 0, 0
    for _ in range(10):
        current = TriangleMesh(mesh.vertices, faces)
        flat = np.flatnonzero(zero_area_faces(current))
        if not len(flat):
            break
        edges = set(map(tuple, current.edges.tolist()))
        kept, locked = np.ones(len(faces), dtype=bool), set()
        sides = current.vertices[faces[:, [1, 2, 0]]] - current.vertices[faces]
        longest = (sides[flat] ** 2).sum(axis=2).argmax(axis=1)
        for f, side in zip(flat.tolist(), longest.tolist(), strict=True):
            neighbours = [
                g for g in np.flatnonzero((current.face_edges == current.face_edges[f, side]).any(axis=1)) if g != f
            ]
            if f in locked or any(g in locked for g in neighbours):
                continue
            a, b, tip = (int(faces[f, (side + k) % 3]) for k in range(3))
            opposite = int(faces[neighbours[0]].sum()) - a - b if len(neighbours) == 1 else tip
            locked.update([f, *neighbours])
            if opposite == tip or (min(tip, opposite), max(tip, opposite)) in edges:
                kept[f], dropped = False, dropped + 1
                continue
            neighbour = faces[neighbours[0]]
            faces[f] = np.where(neighbour == a, tip, neighbour)
            faces[neighbours[0]] = np.where(neighbour == b, tip, neighbour)
            edges.add((min(tip, opposite), max(tip, opposite)))
            flipped += 1
        faces = faces[kept]
    flat_mask = zero_area_faces(TriangleMesh(mesh.vertices, faces))
    dropped += int(flat_mask.sum())
    if flipped:
        changes.append(f"merged into a neighbour by an edge flip, because they had no area: {flipped} faces")
    if dropped:
        changes.append(f"dropped, because they had no area: {dropped} faces")
    return faces[~flat_mask]


def drop_faces_at_crowded_edges(mesh: TriangleMesh, changes: list[str]) -> Integers:
    """The faces without those too many at non-manifold edges: first the ones with most free sides, then the smallest."""
    kept = np.arange(len(mesh.faces))
    crowded_edges = int((mesh.edge_face_counts > 2).sum())
    current = mesh
    while (current.edge_face_counts > 2).any():
        free = (current.edge_face_counts[current.face_edges] == 1).sum(axis=1)
        crowded = (current.edge_face_counts[current.face_edges] > 2).sum(axis=1)
        # worst first: most free sides, then most crowded sides, then least area
        order = np.lexsort([current.areas, -crowded, -free])
        order = order[crowded[order] > 0]
        doomed, touched = [], np.zeros(len(current.edges), dtype=bool)
        for f in order.tolist():
            if not touched[current.face_edges[f]].any():
                touched[current.face_edges[f]] = True
                doomed.append(f)
        rest = np.delete(np.arange(len(kept)), doomed)
        kept = kept[rest]
        current = TriangleMesh(mesh.vertices, mesh.faces[kept])
    if crowded_edges:
        changes.append(
            f"dropped, because {crowded_edges} edges had more than two faces: {len(mesh.faces) - len(kept)} faces"
        )
    return mesh.faces[kept]
