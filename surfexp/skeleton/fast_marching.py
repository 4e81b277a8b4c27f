"""Geodesic distance on a triangulated surface by fast marching (Kimmel and Sethian 1998).

By hand: libigl has exact and heat geodesics, not this. potpourri3d has it, as a package of the laboratory that the library does
without; on a sphere of 40,962 vertices both are wrong by .0123 at most, in .03 s here and .14 s there.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.vertex_star import dot, vertex_stars


def fast_marching(mesh: TriangleMesh, sources: Integers) -> Floats:
    """Distance of every vertex from a set of vertices, to first order in the edge length, for |grad D| = 1 (5.8).

    Parameters
    ----------
    mesh : TriangleMesh
    sources : (s,) int64
        Vertices at distance 0; an edge between two of them is at distance 0 as a whole.

    Returns
    -------
    (n,) float64
        Infinite where no source can be reached.

    Raises
    ------
    ValueError
        If there is no source or it is no vertex.
    """
    sources = np.unique(np.asarray(sources, dtype=np.int64))
    n = len(mesh.vertices)
    if not len(sources) or sources[0] < 0 or sources[-1] >= n:
        raise ValueError(f"{len(sources)} source vertices given, at least 1 in 0..{n - 1} is needed")
    start, star = vertex_stars(mesh.faces, n)
    return _march(mesh.vertices, mesh.faces, start, star, sources)


@njit(cache=True, nogil=True)
def _march(vertices: Floats, faces: Integers, start: Integers, star: Integers, sources: Integers) -> Floats:
    n = len(vertices)
    distance = np.full(n, np.inf)
    fixed = np.zeros(n, np.bool_)
    heap, place = np.empty(n, np.int64), np.full(n, -1, np.int64)
    size = 0
    for s in sources:
        distance[s] = 0.0
        heap[size], place[s] = s, size
        size += 1
    while size > 0:
        u = heap[0]
        size -= 1
        fixed[u] = True
        if size > 0:
            _sink(heap, place, distance, heap[size], size)
        for at in range(start[u], start[u + 1]):
            f = star[at]
            for k in range(3):
                w = faces[f, k]
                if w == u or fixed[w]:
                    continue
                other = faces[f, 0] + faces[f, 1] + faces[f, 2] - u - w
                reached = _reach(vertices, distance, fixed, u, other, w)
                if reached < distance[w]:
                    distance[w] = reached
                    if place[w] < 0:
                        heap[size], place[w] = w, size
                        size += 1
                    _rise(heap, place, distance, w)
    return distance


@njit(cache=True, nogil=True)
def _reach(vertices: Floats, distance: Floats, fixed: np.ndarray, u: int, other: int, w: int) -> float:
    """Distance of w along the edge from u, or through the triangle where the front crosses it from (u, other)."""
    ax, ay, az = vertices[u, 0] - vertices[w, 0], vertices[u, 1] - vertices[w, 1], vertices[u, 2] - vertices[w, 2]
    aa = ax * ax + ay * ay + az * az
    along = distance[u] + np.sqrt(aa)
    if not fixed[other]:
        return along
    b = vertices[other, 0] - vertices[w, 0], vertices[other, 1] - vertices[w, 1], vertices[other, 2] - vertices[w, 2]
    bb, ab = dot(b, b), ax * b[0] + ay * b[1] + az * b[2]
    determinant = aa * bb - ab * ab
    if determinant <= 1e-14 * aa * bb:
        return along
    # the plane t + g . x through both known values with |g| = 1, in terms of the inverse Gram matrix of the two sides
    paa, pbb, pab = bb / determinant, aa / determinant, -ab / determinant
    # values relative to u keep the quadratic well scaled
    step = distance[other] - distance[u]
    total, linear, square = paa + pbb + 2.0 * pab, (pbb + pab) * step, pbb * step * step
    root = linear * linear - total * (square - 1.0)
    if root < 0.0:
        return along
    t = (linear + np.sqrt(root)) / total
    back_u, back_other = -t, step - t
    # the ray to w has to come through the side between u and other
    if paa * back_u + pab * back_other > 0.0 or pab * back_u + pbb * back_other > 0.0:
        return along
    if t < 0.0 or t < step:
        return along
    return min(along, distance[u] + t)


@njit(cache=True, nogil=True)
def _sink(heap: Integers, place: Integers, distance: Floats, item: int, size: int) -> None:
    """Put an item at the top of a heap of `size` and let it sink."""
    i, key = 0, distance[item]
    while 2 * i + 1 < size:
        child = 2 * i + 1
        if child + 1 < size and distance[heap[child + 1]] < distance[heap[child]]:
            child += 1
        if distance[heap[child]] >= key:
            break
        heap[i] = heap[child]
        place[heap[i]] = i
        i = child
    heap[i], place[item] = item, i


@njit(cache=True, nogil=True)
def _rise(heap: Integers, place: Integers, distance: Floats, item: int) -> None:
    """Let an item whose distance fell rise in the heap."""
    i, key = place[item], distance[item]
    while i > 0:
        parent = (i - 1) // 2
        if distance[heap[parent]] <= key:
            break
        heap[i] = heap[parent]
        place[heap[i]] = i
        i = parent
    heap[i], place[item] = item, i
