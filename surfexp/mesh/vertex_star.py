"""The faces around a vertex and across an edge, and vectors between vertices, for compiled loops over a mesh."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats, Integers

# vectors are tuples here: small arrays inside a compiled loop cost an allocation each
Vector = tuple[float, float, float]


@njit(cache=True, nogil=True)
def difference(vertices: Floats, a: int, b: int) -> Vector:
    """The vector from vertex a to vertex b."""
    return vertices[b, 0] - vertices[a, 0], vertices[b, 1] - vertices[a, 1], vertices[b, 2] - vertices[a, 2]


@njit(cache=True, nogil=True)
def dot(u: Vector, v: Vector) -> float:
    """Scalar product."""
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


@njit(cache=True, nogil=True)
def cross(u: Vector, v: Vector) -> Vector:
    """Vector product."""
    return u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]


@njit(cache=True, nogil=True)
def normal(vertices: Floats, a: int, b: int, c: int) -> Vector:
    """Normal of the triangle (a, b, c), its length twice the area."""
    return cross(difference(vertices, a, b), difference(vertices, a, c))


@njit(cache=True, nogil=True)
def cosine(u: Vector, v: Vector) -> float:
    """Cosine of the angle between two vectors."""
    return dot(u, v) / max(np.sqrt(dot(u, u) * dot(v, v)), 1e-300)


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
def boundary_edges(faces: Integers, vertex_count: int) -> Integers:
    """(b, 2) edges with one face, in its direction."""
    start, star = vertex_stars(faces, vertex_count)
    edges, count = np.empty((faces.size, 2), np.int64), 0
    for f in range(len(faces)):
        for k in range(3):
            a, b = faces[f, k], faces[f, (k + 1) % 3]
            if across(faces, start, star, f, a, b)[0] < 0:
                edges[count, 0], edges[count, 1] = a, b
                count += 1
    return edges[:count].copy()
