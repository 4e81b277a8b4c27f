"""Edge split, collapse and flip on independent sets of edges, the moves of isotropic remeshing.

Each pass reads the faces it was given and changes every face at most once, so that the edges treated in one pass do not
see one another. Only manifold meshes are understood; topology is kept.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.mesh.triangle_mesh import Floats, Integers


@njit(cache=True, nogil=True)
def vertex_stars(faces: Integers, vertex_count: int) -> tuple[Integers, Integers]:
    """Faces around each vertex in compressed rows: those of vertex i are star[start[i]:start[i + 1]]."""
    start = np.zeros(vertex_count + 1, np.int64)
    for corner in faces.ravel():
        start[corner + 1] += 1
    start = np.cumsum(start)
    cursor, star = start[:-1].copy(), np.empty(faces.size, np.int64)
    for f in range(len(faces)):
        for k in range(3):
            star[cursor[faces[f, k]]] = f
            cursor[faces[f, k]] += 1
    return start, star


@njit(cache=True, nogil=True)
def across(faces: Integers, start: Integers, star: Integers, face: int, a: int, b: int) -> tuple[int, int]:
    """The other face at edge (a, b) and its vertex opposite, or (-1, -1) on the boundary."""
    for g in star[start[a] : start[a + 1]]:
        if g != face:
            for k in range(3):
                if faces[g, k] == b:
                    return g, faces[g, 0] + faces[g, 1] + faces[g, 2] - a - b
    return -1, -1


@njit(cache=True, nogil=True)
def boundary_vertices(faces: Integers, vertex_count: int) -> np.ndarray:
    """(n,) bool, the vertices on a boundary edge."""
    start, star = vertex_stars(faces, vertex_count)
    boundary = np.zeros(vertex_count, np.bool_)
    for f in range(len(faces)):
        for k in range(3):
            a, b = faces[f, k], faces[f, (k + 1) % 3]
            if across(faces, start, star, f, a, b)[0] < 0:
                boundary[a] = boundary[b] = True
    return boundary


@njit(cache=True, nogil=True)
def half_edges_by_length(vertices: Floats, faces: Integers, low: float, high: float) -> tuple[Integers, Floats]:
    """Half-edges 3 f + k with a length within [low, high], shortest first, and their lengths."""
    lengths = np.empty(faces.size)
    for f in range(len(faces)):
        for k in range(3):
            difference = vertices[faces[f, (k + 1) % 3]] - vertices[faces[f, k]]
            lengths[3 * f + k] = np.sqrt((difference**2).sum())
    chosen = np.flatnonzero((lengths >= low) & (lengths <= high))
    order = chosen[np.argsort(lengths[chosen], kind="mergesort")]
    return order, lengths[order]


@njit(cache=True, nogil=True)
def split_edges(vertices: Floats, faces: Integers, longest: float, limit: int) -> tuple[Floats, Integers]:
    """Halve edges longer than `longest`, the longest first, at most `limit` of them."""
    n, m = len(vertices), len(faces)
    start, star = vertex_stars(faces, n)
    order = half_edges_by_length(vertices, faces, longest, np.inf)[0]
    locked = np.zeros(m, np.bool_)
    new_vertices, new_faces = np.empty((n + m, 3)), np.empty((3 * m, 3), np.int64)
    new_vertices[:n], new_faces[:m] = vertices, faces
    for half_edge in order[::-1]:
        f, k = half_edge // 3, half_edge % 3
        a, b, c = faces[f, k], faces[f, (k + 1) % 3], faces[f, (k + 2) % 3]
        g, d = across(faces, start, star, f, a, b)
        if n - len(vertices) >= limit or locked[f] or (g >= 0 and (locked[g] or a > b)):
            continue
        new_vertices[n] = 0.5 * (vertices[a] + vertices[b])
        new_faces[f] = a, n, c
        new_faces[m] = n, b, c
        locked[f], m = True, m + 1
        if g >= 0:
            new_faces[g] = b, n, d
            new_faces[m] = n, a, d
            locked[g], m = True, m + 1
        n += 1
    return new_vertices[:n].copy(), new_faces[:m].copy()


@njit(cache=True, nogil=True)
def _common_neighbours(faces: Integers, start: Integers, star: Integers, a: int, b: int) -> int:
    common = 0
    seen = np.empty(2 * (start[a + 1] - start[a]), np.int64)
    count = 0
    for f in star[start[a] : start[a + 1]]:
        for x in faces[f]:
            if x != a and x != b and x not in seen[:count]:
                seen[count] = x
                count += 1
                found = False
                for g in star[start[b] : start[b + 1]]:
                    found = found or x in faces[g]
                common += found
    return common


@njit(cache=True, nogil=True)
def _collapse_is_safe(
    vertices: Floats, faces: Integers, start: Integers, star: Integers, a: int, b: int, point: Floats, longest: float
) -> bool:
    """Whether moving a and b to `point` turns no face by more than 60 degrees and makes no edge over `longest`."""
    corners = np.empty((3, 3))
    for end in (a, b):
        for f in star[start[end] : start[end + 1]]:
            if a in faces[f] and b in faces[f]:
                continue
            for k in range(3):
                corners[k] = vertices[faces[f, k]]
            before = np.cross(corners[1] - corners[0], corners[2] - corners[0])
            for k in range(3):
                if faces[f, k] == end:
                    corners[k] = point
                elif ((vertices[faces[f, k]] - point) ** 2).sum() > longest**2:
                    return False
            after = np.cross(corners[1] - corners[0], corners[2] - corners[0])
            if (before * after).sum() <= 0.5 * np.sqrt((before**2).sum() * (after**2).sum()):
                return False
    return True


@njit(cache=True, nogil=True)
def collapse_edges(
    vertices: Floats, faces: Integers, shortest: float, longest: float, limit: int
) -> tuple[Floats, Integers]:
    """Contract edges shorter than `shortest`, the shortest first, at most `limit`, making none over `longest`."""
    n = len(vertices)
    start, star = vertex_stars(faces, n)
    boundary = boundary_vertices(faces, n)
    locked, removed = np.zeros(len(faces), np.bool_), np.zeros(len(faces), np.bool_)
    valence = start[1:] - start[:-1]
    target, moved, done = np.arange(n), vertices.copy(), 0
    for half_edge in half_edges_by_length(vertices, faces, 0.0, shortest)[0]:
        f, k = half_edge // 3, half_edge % 3
        a, b, c = faces[f, k], faces[f, (k + 1) % 3], faces[f, (k + 2) % 3]
        g, d = across(faces, start, star, f, a, b)
        if done >= limit or (g >= 0 and (a > b or (boundary[a] and boundary[b]))):
            continue
        if locked[star[start[a] : start[a + 1]]].any() or locked[star[start[b] : start[b + 1]]].any():
            continue
        if valence[c] <= 3 or (g >= 0 and valence[d] <= 3):
            continue
        if _common_neighbours(faces, start, star, a, b) != (1 if g < 0 else 2):
            continue
        point = 0.5 * (vertices[a] + vertices[b])
        if boundary[a] != boundary[b]:
            point = vertices[a] if boundary[a] else vertices[b]
        if not _collapse_is_safe(vertices, faces, start, star, a, b, point, longest):
            continue
        target[b], moved[a] = a, point
        locked[star[start[a] : start[a + 1]]] = True
        locked[star[start[b] : start[b + 1]]] = True
        removed[f], done = True, done + 1
        valence[c] -= 1
        if g >= 0:
            removed[g] = True
            valence[d] -= 1
    number = np.cumsum(target == np.arange(n)) - 1
    kept = faces[~removed]
    for i in range(len(kept)):
        for k in range(3):
            kept[i, k] = number[target[kept[i, k]]]
    return moved[target == np.arange(n)], kept


@njit(cache=True, nogil=True)
def _opposite_cosine(a: Floats, b: Floats, c: Floats) -> float:
    u, v = a - c, b - c
    return (u * v).sum() / max(np.sqrt((u**2).sum() * (v**2).sum()), 1e-300)


@njit(cache=True, nogil=True)
def flip_edges(vertices: Floats, faces: Integers) -> tuple[Integers, int]:
    """Flip edges whose opposite angles exceed 180 degrees (Delaunay) where the surface is flat enough; also the count."""
    n = len(vertices)
    start, star = vertex_stars(faces, n)
    locked, gained = np.zeros(len(faces), np.bool_), np.zeros(n, np.bool_)
    valence = start[1:] - start[:-1]
    flipped, count = faces.copy(), 0
    for f in range(len(faces)):
        for k in range(3):
            a, b, c = faces[f, k], faces[f, (k + 1) % 3], faces[f, (k + 2) % 3]
            g, d = across(faces, start, star, f, a, b)
            if g < f or locked[f] or locked[g] or min(valence[a], valence[b]) <= 3 or (gained[c] and gained[d]):
                continue
            pa, pb, pc, pd = vertices[a], vertices[b], vertices[c], vertices[d]
            first, second = _opposite_cosine(pa, pb, pc), _opposite_cosine(pa, pb, pd)
            if first + second >= -1e-9 or across(faces, start, star, -1, c, d)[0] >= 0:
                continue
            normal = np.cross(pb - pa, pc - pa) + np.cross(pd - pa, pb - pa)
            one, two = np.cross(pd - pa, pc - pa), np.cross(pb - pd, pc - pd)
            bound = 0.5 * np.sqrt((normal**2).sum())
            if min((one * normal).sum() / np.sqrt((one**2).sum()), (two * normal).sum() / np.sqrt((two**2).sum())) < bound:
                continue
            flipped[f] = a, d, c
            flipped[g] = d, b, c
            locked[f] = locked[g] = gained[c] = gained[d] = True
            valence[a], valence[b] = valence[a] - 1, valence[b] - 1
            count += 1
    return flipped, count
