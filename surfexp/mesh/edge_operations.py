"""Edge split, collapse and flip on independent sets of edges, the moves of isotropic remeshing.

Each pass reads the faces it was given and changes every face at most once, so that the edges treated in one pass do not
see one another. Only manifold meshes are understood; topology is kept.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.vertex_star import (
    Vector,
    across,
    boundary_edges,
    cosine,
    cross,
    difference,
    dot,
    normal,
    vertex_stars,
)


def half_edges_by_length(vertices: Floats, faces: Integers, low: float, high: float) -> Integers:
    """Half-edges 3 f + k with a length within [low, high], shortest first."""
    lengths = _half_edge_lengths(vertices, faces)
    chosen = np.flatnonzero((lengths >= low) & (lengths <= high))
    return chosen[np.argsort(lengths[chosen], kind="stable")]


@njit(cache=True, nogil=True)
def _half_edge_lengths(vertices: Floats, faces: Integers) -> Floats:
    lengths = np.empty(faces.size)
    for f in range(len(faces)):
        for k in range(3):
            side = difference(vertices, faces[f, k], faces[f, (k + 1) % 3])
            lengths[3 * f + k] = np.sqrt(dot(side, side))
    return lengths


def split_edges(vertices: Floats, faces: Integers, longest: float, limit: int) -> tuple[Floats, Integers]:
    """Halve edges longer than `longest`, the longest first, at most `limit` of them."""
    n, m = len(vertices), len(faces)
    order = half_edges_by_length(vertices, faces, longest, np.inf)
    new_vertices = np.concatenate([vertices, np.empty((m, 3))])
    new_faces = np.concatenate([faces, np.empty((2 * m, 3), np.int64)])
    n, m = _split(faces, n, order[::-1].copy(), limit, new_vertices, new_faces)
    return new_vertices[:n].copy(), new_faces[:m].copy()


@njit(cache=True, nogil=True)
def _split(
    faces: Integers, n: int, order: Integers, limit: int, new_vertices: Floats, new_faces: Integers
) -> tuple[int, int]:
    """Write the halves behind the n vertices and the faces there were; return how many there are."""
    most, m = n + limit, len(faces)
    start, star = vertex_stars(faces, n)
    locked = np.zeros(m, np.bool_)
    for half_edge in order:
        f, k = half_edge // 3, half_edge % 3
        a, b, c = faces[f, k], faces[f, (k + 1) % 3], faces[f, (k + 2) % 3]
        g, d = across(faces, start, star, f, a, b)
        if n >= most or locked[f] or (g >= 0 and (locked[g] or a > b)):
            continue
        for axis in range(3):
            new_vertices[n, axis] = 0.5 * (new_vertices[a, axis] + new_vertices[b, axis])
        _write(new_faces, f, a, n, c)
        _write(new_faces, m, n, b, c)
        locked[f], m = True, m + 1
        if g >= 0:
            _write(new_faces, g, b, n, d)
            _write(new_faces, m, n, a, d)
            locked[g], m = True, m + 1
        n += 1
    return n, m


@njit(cache=True, nogil=True)
def _write(faces: Integers, f: int, a: int, b: int, c: int) -> None:
    faces[f, 0], faces[f, 1], faces[f, 2] = a, b, c


@njit(cache=True, nogil=True)
def _common_neighbours(faces: Integers, start: Integers, star: Integers, a: int, b: int) -> int:
    """Number of pairs of a face at a and a face at b that share a vertex besides, a and b being adjacent."""
    common = 0
    for i in range(start[a], start[a + 1]):
        for k in range(3):
            x = faces[star[i], k]
            # each neighbour once: where it follows a in the face, or comes before it at a boundary
            if (
                x != a
                and x != b
                and (faces[star[i], (k + 2) % 3] == a or across(faces, start, star, star[i], a, x)[0] < 0)
            ):
                for j in range(start[b], start[b + 1]):
                    if faces[star[j], 0] == x or faces[star[j], 1] == x or faces[star[j], 2] == x:
                        common += 1
                        break
    return common


@njit(cache=True, nogil=True)
def _collapse_is_safe(
    vertices: Floats, faces: Integers, start: Integers, star: Integers, a: int, b: int, point: Vector, longest: float
) -> bool:
    """Whether moving a and b to `point` turns no face by more than 60 degrees and makes no edge over `longest`."""
    for end, other in ((a, b), (b, a)):
        for i in range(start[end], start[end + 1]):
            f = star[i]
            k = 0 if faces[f, 0] == end else 1 if faces[f, 1] == end else 2
            x, y = faces[f, (k + 1) % 3], faces[f, (k + 2) % 3]
            if x == other or y == other:
                continue
            to_x = vertices[x, 0] - point[0], vertices[x, 1] - point[1], vertices[x, 2] - point[2]
            to_y = vertices[y, 0] - point[0], vertices[y, 1] - point[1], vertices[y, 2] - point[2]
            if max(dot(to_x, to_x), dot(to_y, to_y)) > longest**2:
                return False
            if cosine(normal(vertices, end, x, y), cross(to_x, to_y)) <= 0.5:
                return False
    return True


def collapse_edges(
    vertices: Floats, faces: Integers, shortest: float, longest: float, limit: int
) -> tuple[Floats, Integers]:
    """Contract edges shorter than `shortest`, the shortest first, at most `limit`, making none over `longest`."""
    order = half_edges_by_length(vertices, faces, 0.0, shortest)
    target, moved, removed = _collapse(vertices, faces, order, longest, limit)
    stays = target == np.arange(len(vertices))
    number = np.cumsum(stays) - 1
    return moved[stays], number[target[faces[~removed]]]


@njit(cache=True, nogil=True)
def _collapse(
    vertices: Floats, faces: Integers, order: Integers, longest: float, limit: int
) -> tuple[Integers, Floats, NDArray[np.bool_]]:
    """The vertex that each one becomes, where they move, and the faces that go."""
    n = len(vertices)
    start, star = vertex_stars(faces, n)
    boundary = np.zeros(n, np.bool_)
    for edge in boundary_edges(faces, n):
        boundary[edge[0]] = True
    locked, removed = np.zeros(len(faces), np.bool_), np.zeros(len(faces), np.bool_)
    valence = start[1:] - start[:-1]
    target, moved, done = np.arange(n), vertices.copy(), 0
    for half_edge in order:
        f, k = half_edge // 3, half_edge % 3
        a, b, c = faces[f, k], faces[f, (k + 1) % 3], faces[f, (k + 2) % 3]
        g, d = across(faces, start, star, f, a, b)
        if done >= limit or (g >= 0 and (a > b or (boundary[a] and boundary[b]))):
            continue
        if _any_locked(locked, start, star, a) or _any_locked(locked, start, star, b):
            continue
        if valence[c] <= 3 or (g >= 0 and valence[d] <= 3):
            continue
        if _common_neighbours(faces, start, star, a, b) != (1 if g < 0 else 2):
            continue
        share = 0.5 if boundary[a] == boundary[b] else 0.0 if boundary[a] else 1.0
        step = difference(vertices, a, b)
        point = (
            vertices[a, 0] + share * step[0],
            vertices[a, 1] + share * step[1],
            vertices[a, 2] + share * step[2],
        )
        if not _collapse_is_safe(vertices, faces, start, star, a, b, point, longest):
            continue
        target[b], moved[a, 0], moved[a, 1], moved[a, 2] = a, point[0], point[1], point[2]
        for end in (a, b):
            for at in range(start[end], start[end + 1]):
                locked[star[at]] = True
        removed[f], done = True, done + 1
        valence[c] -= 1
        if g >= 0:
            removed[g] = True
            valence[d] -= 1
    return target, moved, removed


@njit(cache=True, nogil=True)
def _any_locked(locked: NDArray[np.bool_], start: Integers, star: Integers, vertex: int) -> bool:
    found = False
    for at in range(start[vertex], start[vertex + 1]):
        found = found or locked[star[at]]
    return found


@njit(cache=True, nogil=True)
def flip_edges(vertices: Floats, faces: Integers) -> tuple[Integers, int]:
    """Flip edges whose opposite angles exceed 180 degrees (Delaunay) where the surface is flat enough; also the count."""
    n = len(vertices)
    start, star = vertex_stars(faces, n)
    locked, gained = np.zeros(len(faces), np.bool_), np.zeros(n, np.bool_)
    # how many faces a vertex can lose: three must stay around it, on the boundary one
    spare = start[1:] - start[:-1] - 3
    for edge in boundary_edges(faces, n):
        spare[edge[0]] += 2
    flipped, count = faces.copy(), 0
    for f in range(len(faces)):
        for k in range(3):
            a, b, c = faces[f, k], faces[f, (k + 1) % 3], faces[f, (k + 2) % 3]
            g, d = across(faces, start, star, f, a, b)
            if g < f or locked[f] or locked[g] or min(spare[a], spare[b]) <= 0 or (gained[c] and gained[d]):
                continue
            angles = cosine(difference(vertices, c, a), difference(vertices, c, b)) + cosine(
                difference(vertices, d, a), difference(vertices, d, b)
            )
            if angles >= -1e-9 or across(faces, start, star, -1, c, d)[0] >= 0:
                continue
            one, two = normal(vertices, a, b, c), normal(vertices, a, d, b)
            mean = one[0] + two[0], one[1] + two[1], one[2] + two[2]
            if min(cosine(normal(vertices, a, d, c), mean), cosine(normal(vertices, d, b, c), mean)) < 0.5:
                continue
            _write(flipped, f, a, d, c)
            _write(flipped, g, d, b, c)
            locked[f] = locked[g] = gained[c] = gained[d] = True
            spare[a], spare[b] = spare[a] - 1, spare[b] - 1
            count += 1
    return flipped, count
