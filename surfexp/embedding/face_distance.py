"""Distance of points to a triangulated surface in any number of dimensions, exact: the mesh-independent form of (6.18)."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats, Integers
from surfexp.embedding.mean_hausdorff import Summary, summarised
from surfexp.embedding.nearest import nearest
from surfexp.embedding.spectral_embedding import SpectralEmbedding, check_pair


def distance_to_faces(points: Floats, vertices: Floats, faces: Integers) -> Floats:
    """Return the distance of each point to the nearest point of any triangle.

    The triangles around the nearest vertex give a bound u. A triangle of longest edge L has each of its points within
    L / sqrt 3 of a corner, so only those with a corner nearer than u + L / sqrt 3 are looked at.

    Parameters
    ----------
    points : (p, n) float64
    vertices : (q, n) float64
    faces : (m, 3) int64

    Raises
    ------
    ValueError
        If dimensions differ, there is no face, or a face names a vertex that is not there.
    """
    if points.ndim != 2 or vertices.ndim != 2 or points.shape[1] != vertices.shape[1]:
        raise ValueError(f"points {points.shape} and vertices {vertices.shape} must have the same number of columns")
    if not len(faces) or faces.min() < 0 or faces.max() >= len(vertices):
        raise ValueError(f"{len(faces)} faces must name vertices 0..{len(vertices) - 1}, at least 1 face is needed")
    corners = vertices[faces]
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    order = np.argsort(faces.ravel(), kind="stable") // 3
    starts = np.concatenate([[0], np.cumsum(np.bincount(faces.ravel(), minlength=len(vertices)))])
    used = np.flatnonzero(np.diff(starts))
    reach = np.zeros(len(vertices))
    np.maximum.at(reach, faces.ravel(), np.repeat(longest, 3) / np.sqrt(3.0))
    first = used[nearest(np.ascontiguousarray(points), np.ascontiguousarray(vertices[used]))[0]]
    return np.asarray(_distances(np.ascontiguousarray(points), vertices, faces, starts, order, reach, used, first))


def distance_on_faces(
    source: SpectralEmbedding,
    target: SpectralEmbedding,
    source_faces: Integers,
    target_faces: Integers,
    summary: Summary = "mean",
) -> float:
    """Return the distance of two embedded surfaces with distances to faces in place of those to vertices.

    Parameters
    ----------
    source, target : SpectralEmbedding
        In the bases in which they are compared, such as the optimal signs.
    source_faces, target_faces : (m, 3) int64
    summary : "mean" or "largest"
    """
    check_pair(source, target)
    forward = distance_to_faces(source.points, target.points, target_faces)
    backward = distance_to_faces(target.points, source.points, source_faces)
    return summarised(forward, backward, source, target, "both", summary)


@njit(cache=True, nogil=True)
def _distances(
    points: Floats,
    vertices: Floats,
    faces: Integers,
    starts: Integers,
    around: Integers,
    reach: Floats,
    used: Integers,
    first: Integers,
) -> Floats:
    count, n = points.shape
    result = np.empty(count)
    seen = np.full(len(faces), -1)
    dots = np.empty(5)
    for p in range(count):
        best = np.inf
        for place in range(-1, len(used)):
            v = first[p] if place < 0 else used[place]
            if place >= 0:
                bound = (np.sqrt(best) + reach[v]) ** 2
                square = 0.0
                for k in range(n):
                    square += (points[p, k] - vertices[v, k]) ** 2
                    if square > bound:
                        break
                if square > bound:
                    continue
            for entry in range(starts[v], starts[v + 1]):
                f = around[entry]
                if seen[f] != p:
                    seen[f] = p
                    best = min(best, _square_to_triangle(points[p], vertices, faces[f], dots))
        result[p] = np.sqrt(best)
    return result


@njit(cache=True, nogil=True)
def _square_to_triangle(point: Floats, vertices: Floats, face: Integers, dots: Floats) -> float:
    """Squared distance to a triangle: to the plane where the foot lies inside, else the least over its edges."""
    dots[:] = 0.0
    square = 0.0
    for k in range(len(point)):
        u = vertices[face[1], k] - vertices[face[0], k]
        v = vertices[face[2], k] - vertices[face[0], k]
        w = point[k] - vertices[face[0], k]
        dots[0] += u * u
        dots[1] += u * v
        dots[2] += v * v
        dots[3] += u * w
        dots[4] += v * w
        square += w * w
    uu, uv, vv, uw, vw = dots
    determinant = uu * vv - uv * uv
    if determinant > 1e-14 * uu * vv:
        s, t = (vv * uw - uv * vw) / determinant, (uu * vw - uv * uw) / determinant
        if s >= 0.0 and t >= 0.0 and s + t <= 1.0:
            return max(square - s * uw - t * vw, 0.0)
    # edges: from the first corner to the second and third, and from the second to the third
    s = min(max(uw / uu, 0.0), 1.0) if uu > 0.0 else 0.0
    least = square - 2.0 * s * uw + s * s * uu
    t = min(max(vw / vv, 0.0), 1.0) if vv > 0.0 else 0.0
    least = min(least, square - 2.0 * t * vw + t * t * vv)
    length = uu - 2.0 * uv + vv
    along = vw - uw - uv + uu
    r = min(max(along / length, 0.0), 1.0) if length > 0.0 else 0.0
    third = square - 2.0 * uw + uu - 2.0 * r * along + r * r * length
    return max(min(least, third), 0.0)
