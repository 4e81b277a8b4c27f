"""Isotropic remeshing of an implicit surface to a given number of vertices (after Botsch and Kobbelt 2004)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from surfexp.mesh.edge_operations import boundary_vertices, collapse_edges, flip_edges, split_edges
from surfexp.mesh.triangle_mesh import Floats, Integers, TriangleMesh

Implicit = Callable[[Floats], Floats]


def remesh(
    vertices: Floats, faces: Integers, implicit: Implicit, count: int, floor: float | None = None, rounds: int = 6
) -> TriangleMesh:
    """Nearly equilateral triangles on {implicit = 0} with exactly `count` vertices, in the topology of the faces given.

    Parameters
    ----------
    vertices, faces : arrays
        A manifold mesh close to the surface, from marching cubes for instance.
    implicit : callable
        (n, 3) points to (n,) values, negative inside.
    count : int
        Number of vertices wanted.
    floor : float, optional
        Height z of the plane in which every boundary of the mesh lies, and stays.
    rounds : int
        Rounds of split, collapse, flip and smoothing.

    Raises
    ------
    ValueError
        If the count cannot be reached.
    """
    mesh = TriangleMesh(vertices, faces)
    edge = float(np.sqrt(2.0 * mesh.area / (np.sqrt(3.0) * count)))
    for _ in range(rounds):
        vertices, faces = split_edges(vertices, faces, 1.33 * edge, len(vertices))
        for _ in range(3):
            vertices, faces = collapse_edges(vertices, faces, 0.78 * edge, 1.33 * edge, len(vertices))
        vertices, faces = _relax(vertices, faces, implicit, floor, sweeps=2)
        edge *= float(np.clip(np.sqrt(len(vertices) / count), 0.9, 1.1))
    vertices, faces = _adjust_count(vertices, faces, count)
    return TriangleMesh(*_relax(vertices, faces, implicit, floor, sweeps=4))


def _adjust_count(vertices: Floats, faces: Integers, count: int) -> tuple[Floats, Integers]:
    for _ in range(20):
        excess = len(vertices) - count
        if excess > 0:
            vertices, faces = collapse_edges(vertices, faces, np.inf, np.inf, excess)
        elif excess < 0:
            vertices, faces = split_edges(vertices, faces, 0.0, -excess)
        else:
            return vertices, faces
    raise ValueError(f"remeshing reached {len(vertices)} vertices, not {count}: the surface needs more to be resolved")


def _relax(
    vertices: Floats, faces: Integers, implicit: Implicit, floor: float | None, sweeps: int
) -> tuple[Floats, Integers]:
    boundary = boundary_vertices(faces, len(vertices))
    for _ in range(sweeps):
        for _ in range(2):
            faces, _ = flip_edges(vertices, faces)
        vertices = _project(_smooth(vertices, faces, boundary), boundary, implicit, floor)
    for _ in range(8):
        faces, count = flip_edges(vertices, faces)
        if not count:
            break
    return vertices, faces


def _smooth(vertices: Floats, faces: Integers, boundary: np.ndarray) -> Floats:
    """Move each vertex in its tangent plane to the area-weighted mean of its faces, on a boundary along the boundary."""
    mesh = TriangleMesh(vertices, faces)
    corner, weight = faces.ravel(), np.repeat(mesh.areas, 3)
    centres = np.repeat(vertices[faces].mean(axis=1), 3, axis=0) * weight[:, None]
    n = len(vertices)
    mean = np.stack([np.bincount(corner, centres[:, k], n) for k in range(3)], axis=1)
    step = mean / np.bincount(corner, weight, n)[:, None] - vertices
    step -= mesh.vertex_normals * (step * mesh.vertex_normals).sum(axis=1, keepdims=True)
    step[boundary] = 0.0
    if boundary.any():
        for loop in mesh.boundary_loops:
            points = vertices[loop]
            before, after = np.roll(points, 1, axis=0), np.roll(points, -1, axis=0)
            step[loop] = 0.5 * (0.5 * (before + after) - points)
    return vertices + step


def _project(points: Floats, boundary: np.ndarray, implicit: Implicit, floor: float | None, steps: int = 2) -> Floats:
    """Newton's steps onto {implicit = 0}, inside the plane z = floor for boundary vertices."""
    delta = 1e-5
    for _ in range(steps):
        value = implicit(points)
        gradient = np.stack([(implicit(points + delta * axis) - value) / delta for axis in np.eye(3)], axis=1)
        if floor is not None:
            gradient[boundary, 2] = 0.0
        points = points - gradient * (value / np.maximum((gradient**2).sum(axis=1), 1e-12))[:, None]
    if floor is not None:
        points[boundary, 2] = floor
    return points
