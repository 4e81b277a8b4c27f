"""Contraction of edges without length, of which needles of no area hang."""

from __future__ import annotations

from collections import defaultdict

import numpy as np

from surfexp.contract.arrays import Integers
from surfexp.mesh.thin_faces import zero_area_faces
from surfexp.mesh.triangle_mesh import TriangleMesh

# of the longest side of the face that hangs on it
ZERO_LENGTH = 1e-8

Stars = dict[int, set[int]]


def contract_zero_edges(mesh: TriangleMesh, changes: list[str]) -> Integers:
    """Return the faces with the ends of edges without length made one vertex; says so in `changes`.

    Only edges of faces without area are contracted, the shortest first, and only where the surface keeps its topology: the
    ends have no neighbour in common but across the edge, and do not lie on two places of a boundary (the link condition).
    No face that has an area changes its place.

    Parameters
    ----------
    mesh : TriangleMesh
        Without faces that name a vertex twice.
    changes : list of str

    Returns
    -------
    (k, 3) int64
        Vertices keep their numbers; of two ends the smaller one stays.

    Examples
    --------
    >>> corners = np.array([[0.0, 0, 0], [1, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])
    >>> contract_zero_edges(TriangleMesh(corners, np.array([[0, 1, 3], [1, 2, 3], [2, 4, 3]])), [])
    array([[0, 1, 3],
           [1, 4, 3]])
    """
    edges = _zero_edges(mesh)
    if not len(edges):
        return mesh.faces
    faces: dict[int, tuple[int, ...]] = dict(enumerate(map(tuple, mesh.faces.tolist())))
    stars: Stars = defaultdict(set)
    for number, face in faces.items():
        for corner in face:
            stars[corner].add(number)
    standing, merged = np.arange(len(mesh.vertices)), 0
    for a, b in edges.tolist():
        a, b = sorted((_last(standing, a), _last(standing, b)))
        if a == b or not _keeps_topology(faces, stars, a, b):
            continue
        standing[b] = a
        merged += 1
        for number in stars[a] & stars[b]:
            for corner in faces.pop(number):
                stars[corner].discard(number)
        for number in stars.pop(b):
            faces[number] = tuple(a if corner == b else corner for corner in faces[number])
            stars[a].add(number)
    if merged:
        changes.append(f"merged, because an edge without length joined them: {merged} vertices")
    return np.array([faces[number] for number in sorted(faces)], dtype=np.int64).reshape(-1, 3)


def _zero_edges(mesh: TriangleMesh) -> Integers:
    """(k, 2) ends of the edges without length of faces without area, the shortest first, each once."""
    flat = mesh.faces[zero_area_faces(mesh)]
    ends = np.stack([flat, flat[:, [1, 2, 0]]], axis=2)
    lengths = np.linalg.norm(mesh.vertices[ends[:, :, 0]] - mesh.vertices[ends[:, :, 1]], axis=2)
    short = lengths <= ZERO_LENGTH * lengths.max(axis=1, keepdims=True, initial=0.0)
    found, first = np.unique(np.sort(ends[short], axis=1), axis=0, return_index=True)
    return np.asarray(found[np.argsort(lengths[short][first], kind="stable")], dtype=np.int64)


def _last(standing: Integers, vertex: int) -> int:
    while standing[vertex] != vertex:
        vertex = int(standing[vertex])
    return vertex


def _keeps_topology(faces: dict[int, tuple[int, ...]], stars: Stars, a: int, b: int) -> bool:
    """Whether making a and b one vertex neither pinches the surface nor folds two faces onto one another."""
    shared = stars[a] & stars[b]
    if len(shared) not in (1, 2):
        return False
    around = {end: {corner for face in stars[end] for corner in faces[face]} - {a, b} for end in (a, b)}
    across = {corner for face in shared for corner in faces[face]} - {a, b}
    sides = [{frozenset(faces[face]) - {end} for face in stars[end] - shared} for end in (a, b)]
    # around a vertex on the boundary stands one neighbour more than faces
    free = [len(around[end]) + 1 - len(stars[end]) for end in (a, b)]
    if not set(free) <= {0, 1} or (all(free) and len(shared) == 2):
        return False
    return around[a] & around[b] == across and not sides[0] & sides[1]
