"""The narrow band: grid nodes within a fixed distance of a surface, each with its closest point."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

import numpy as np
from numba import njit
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.triangle_mesh import TriangleMesh

Indices = NDArray[np.int32]
LARGEST_GRID = 10**9


@dataclass(frozen=True, eq=False)
class NarrowBand:
    """Nodes of a cubic grid near a surface; nothing is stored for the rest of the grid.

    Attributes
    ----------
    origin : (3,) float64
        Position of the grid point (0, 0, 0).
    step : float
        Grid spacing, in the unit of the surface.
    shape : tuple of int
        Points of the whole grid along each axis.
    radius : float
        Largest distance of a node from the surface.
    keys : (k,) int64
        Row-major position of each node in the whole grid, ascending, so neighbours along z are neighbours in memory.
    forward, backward : (k, 3) int32
        Index of the next and the previous node along each axis, -1 where it is outside the band.
    distance : (k,) float64
        Signed distance, positive outside a closed surface (the sign is arbitrary off the boundary of an open one).
    closest : (k, 3) float64
        Closest point on the surface.
    corners : (k, 3) int32
        Vertices of the triangle that holds the closest point.
    barycentric : (k, 3) float64
        Barycentric coordinates of the closest point in that triangle.
    normals : (k, 3) float64
        Unit normal of the surface at the closest point, interpolated from the vertices.
    """

    origin: Floats
    step: float
    shape: tuple[int, int, int]
    radius: float
    keys: NDArray[np.int64]
    forward: Indices
    backward: Indices
    distance: Floats
    closest: Floats
    corners: Indices
    barycentric: Floats
    normals: Floats

    @property
    def node_count(self) -> int:
        """Number of nodes in the band."""
        return len(self.keys)

    @property
    def memory(self) -> int:
        """Bytes of all arrays."""
        return sum(v.nbytes for v in (getattr(self, f.name) for f in fields(self)) if isinstance(v, np.ndarray))

    @property
    def positions(self) -> Floats:
        """(k, 3) positions of the nodes."""
        return self.origin + self.step * np.stack(np.unravel_index(self.keys, self.shape), axis=1)

    def extend(self, vertex_values: Floats) -> Floats:
        """Extend values at the vertices constant along normals: the value at a node is that at its closest point."""
        return np.einsum("kc,kc->k", self.barycentric, vertex_values[self.corners])


def interpolation_radius(degree: int) -> float:
    """Band radius, in grid steps, that a closest-point method needs with interpolation of a degree (1 or 3).

    sqrt(2 ((p + 1)/2)^2 + (1 + (p + 1)/2)^2): every node of the stencil of a closest point, and every neighbour of such
    a node, is in the band (Ruuth and Merriman 2008).
    """
    half = (degree + 1) / 2
    return math.sqrt(2 * half**2 + (1 + half) ** 2)


def narrow_band(mesh: TriangleMesh, step: float, radius: float) -> NarrowBand:
    """Find the nodes of a cubic grid within a distance of a surface, and their closest points.

    Parameters
    ----------
    mesh : TriangleMesh
    step : float
        Grid spacing, in the unit of the mesh.
    radius : float
        Largest distance, in grid steps; see `interpolation_radius`.

    Raises
    ------
    ValueError
        If the step is not positive, or the grid around the mesh would have more than 1e9 points.
    """
    if not step > 0:
        raise ValueError(f"grid step is {step}, it must be positive; the mesh's edge length is {mesh.edge_length:.4g}")
    padding = _padding(radius)
    lowest = np.floor(mesh.vertices.min(axis=0) / step) - padding
    counts = np.ceil(mesh.vertices.max(axis=0) / step) + padding - lowest + 1
    if counts.prod() > LARGEST_GRID:
        nearest = step * (counts.prod() / LARGEST_GRID) ** (1 / 3)
        raise ValueError(
            f"grid step {step:g} makes {counts.prod():.3g} grid points, the bound is {LARGEST_GRID:g}; "
            f"take a step of at least {nearest:.3g}"
        )
    shape = (int(counts[0]), int(counts[1]), int(counts[2]))
    origin = lowest * step

    import igl

    marked = np.zeros(shape, dtype=np.bool_)
    _mark_candidates(mesh.vertices, mesh.faces, mesh.face_normals, origin, step, radius * step, marked)
    keys = np.flatnonzero(marked)
    points = origin + step * np.stack(np.unravel_index(keys, shape), axis=1)
    distance, face, closest, _ = igl.signed_distance(
        points, mesh.vertices, mesh.faces, igl.SignedDistanceType.SIGNED_DISTANCE_TYPE_PSEUDONORMAL
    )
    near = np.abs(distance) <= radius * step
    keys, closest = keys[near], np.ascontiguousarray(closest[near])
    corners = mesh.faces[face[near]]
    barycentric = igl.barycentric_coordinates(closest, *(mesh.vertices[corners[:, c]] for c in range(3)))
    normals = np.einsum("kc,kcd->kd", barycentric, mesh.vertex_normals[corners])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    strides = (shape[1] * shape[2], shape[2], 1)
    return NarrowBand(
        origin, step, shape, radius * step, keys,
        np.stack([locate(keys, keys + s) for s in strides], axis=1),
        np.stack([locate(keys, keys - s) for s in strides], axis=1),
        distance[near], closest, corners.astype(np.int32), barycentric, normals,
    )  # fmt: skip


def locate(keys: NDArray[np.int64], wanted: NDArray[np.int64]) -> Indices:
    """Index of each wanted key among ascending keys, -1 where it is absent."""
    index = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
    return np.where(keys[index] == wanted, index, -1).astype(np.int32)


def _padding(radius: float) -> int:
    """Grid points between the box of the mesh and the end of the grid, so that no node of the band is at the end."""
    return math.ceil(radius) + 1


@njit(cache=True, nogil=True)
def _mark_candidates(
    vertices: Floats,
    faces: Integers,
    normals: Floats,
    origin: Floats,
    step: float,
    radius: float,
    marked: NDArray[np.bool_],
) -> None:
    """Mark the grid points in the box around each face, grown by the radius, that lie so near to its plane."""
    low, high = np.empty(3, np.int64), np.empty(3, np.int64)
    for f in range(faces.shape[0]):
        for axis in range(3):
            x, y, z = vertices[faces[f, 0], axis], vertices[faces[f, 1], axis], vertices[faces[f, 2], axis]
            low[axis] = math.ceil((min(x, y, z) - radius - origin[axis]) / step)
            high[axis] = math.floor((max(x, y, z) + radius - origin[axis]) / step) + 1
        anchor = vertices[faces[f, 0]]
        for i in range(low[0], high[0]):
            for j in range(low[1], high[1]):
                partial = (origin[0] + i * step - anchor[0]) * normals[f, 0]
                partial += (origin[1] + j * step - anchor[1]) * normals[f, 1]
                for k in range(low[2], high[2]):
                    if abs(partial + (origin[2] + k * step - anchor[2]) * normals[f, 2]) <= radius:
                        marked[i, j, k] = True
