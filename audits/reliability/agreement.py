"""Whether two readers found the same in a file that neither of them wrote."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from audits.reliability.truth import SURFACE, Found, Truth, difference
from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.triangle_mesh import TriangleMesh

SINGLE = 1e-5  # others keep single precision, of a number or of its text
SUMS = 1e-4
LARGEST_POLYGON = 100  # triangles that two readers may cut a polygon into differently


def disagreement(ours: Found, other: Found) -> str:
    """Return how another reader's surface, maps or labels differ from ours; nothing where they do not.

    Others number vertices anew, keep double corners or cut polygons otherwise. So surfaces agree if their arrays do, or
    the corners of their faces in order, or each polygon with its triangles, or the number of triangles, the area and
    the volume, or the boundaries of the polygons that both cut. In the last case ours has to have the smaller area:
    triangles that overlap have the boundary of their polygon and a larger one.
    """
    if ours.vertices is not None and other.vertices is not None and other.polygons is not None:
        said = _of_surfaces(ours, other)
        if said:
            return said
    told = Truth("", maps=other.maps or {}, labels=other.labels or (), mask=other.mask)
    return difference(
        told,
        replace(ours, vertices=None, maps=ours.maps if other.maps is not None else None, named=other.named),
        SINGLE,
    )


def _of_surfaces(ours: Found, other: Found) -> str:
    assert ours.vertices is not None and other.vertices is not None
    assert ours.polygons is not None and other.polygons is not None
    if not len(other.polygons):
        return "no faces"
    size = float(np.nanmax(np.abs(other.vertices), initial=0.0))
    faces = np.asarray(ours.polygons, dtype=np.int64).reshape(-1, 3)
    triangular = all(len(polygon) == 3 for polygon in other.polygons)
    if triangular and len(other.polygons) == len(faces):
        others = np.asarray(other.polygons, dtype=np.int64)
        corners = _from_smallest(ours.vertices[faces]), _from_smallest(other.vertices[others])
        same_count = len(ours.vertices) == len(other.vertices)
        if same_count and np.array_equal(faces, others) and _close(ours.vertices, other.vertices, size):
            return ""
        if _close(*corners, size) or _close(ours.vertices[faces], other.vertices[others], size):
            return ""
    said = difference(Truth(SURFACE, other.vertices, other.polygons), replace(ours, maps=None), SINGLE)
    if not said:
        return ""
    if triangular:
        told = _sums(other.vertices, np.asarray(other.polygons, dtype=np.int64))
        seen = _sums(ours.vertices, faces)
        scale = np.array([1.0, max(told[1], 1e-300), max(abs(told[2]), told[1] ** 1.5 * 1e-3, 1e-300)])
        if np.all(np.abs(told - seen) <= np.array([0.0, SUMS, SUMS]) * scale):
            return ""
        same = len(told) and told[0] == seen[0] and _close(ours.vertices, other.vertices, size)
        if same and seen[1] <= told[1] * (1 + SUMS) and _largest_cut(faces, other.polygons) <= LARGEST_POLYGON:
            return ""
        return f"{said}; triangles, area, volume {_shown(told)}, ours {_shown(seen)}"
    return said


def _largest_cut(ours: Integers, others: Sequence[Sequence[int]]) -> float:
    """Return the largest number of successive triangles that have one boundary together and not before.

    It is infinite where the boundaries differ, or where those of a group vanish, as those of a closed surface do.
    """
    edges, between = Counter[tuple[int, int]](), Counter[tuple[int, int]]()
    since, largest = 0, 0
    for one, two in zip(ours.tolist(), others, strict=True):
        since += 1
        _add(edges, one, 1)
        _add(between, one, 1)
        _add(between, two, -1)
        if not between:
            if not edges:
                return np.inf
            largest, since = max(largest, since), 0
            edges.clear()
    return np.inf if since else largest


def _add(edges: Counter[tuple[int, int]], face: Sequence[int], sign: int) -> None:
    """Add the edges of a face to a chain, in which an edge and its reverse cancel."""
    for a, b in zip(face, (*face[1:], face[0]), strict=True):
        edge, way = ((a, b), sign) if a < b else ((b, a), -sign)
        edges[edge] += way
        if not edges[edge]:
            del edges[edge]


def _from_smallest(corners: Floats) -> Floats:
    """Turn triangles (m, 3, 3), so that the corner of smallest coordinate sum is first."""
    first = corners.sum(axis=2).argmin(axis=1)
    place = (first[:, None] + np.arange(3)) % 3
    return np.take_along_axis(corners, place[:, :, None], axis=1)


def _close(one: Floats, two: Floats, size: float) -> bool:
    return one.shape == two.shape and np.allclose(one, two, rtol=0.0, atol=SINGLE * size, equal_nan=True)


def _sums(vertices: Floats, faces: Integers) -> Floats:
    centred = vertices - np.nanmean(vertices, axis=0)
    mesh = TriangleMesh(centred, faces)
    volume = np.einsum("ij,ij->i", centred[faces[:, 0]], mesh.face_cross_products).sum() / 6.0
    return np.array([len(faces), mesh.areas.sum(), volume])


def _shown(sums: Floats) -> str:
    return f"{int(sums[0])}, {sums[1]:.6g}, {sums[2]:.6g}"
