"""Isotropic remeshing of an implicit surface to a given number of vertices (after Botsch and Kobbelt 2004)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.edge_operations import collapse_edges, flip_edges, split_edges
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.vertex_star import boundary_edges

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
    return TriangleMesh(*_relax(vertices, faces, implicit, floor, sweeps=4, newton_steps=3))


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
    vertices: Floats, faces: Integers, implicit: Implicit, floor: float | None, sweeps: int, newton_steps: int = 1
) -> tuple[Floats, Integers]:
    # no flip touches the boundary
    boundary, reach = boundary_edges(faces, len(vertices)), 0.5 * TriangleMesh(vertices, faces).edge_length
    for _ in range(sweeps):
        faces, _ = flip_edges(vertices, faces)
        vertices = _smooth(vertices, faces, boundary)
        vertices = _project(vertices, boundary[:, 0], implicit, floor, newton_steps, reach)
    for _ in range(8):
        faces, count = flip_edges(vertices, faces)
        if not count:
            break
    return vertices, faces


def _smooth(vertices: Floats, faces: Integers, boundary: Integers) -> Floats:
    """Move each vertex in its tangent plane to the area-weighted mean of its faces, on a boundary along the boundary."""
    mesh = TriangleMesh(vertices, faces)
    weighted = vertices[faces].mean(axis=1) * mesh.areas[:, None]
    target, total = np.zeros_like(vertices), np.bincount(faces.ravel(), np.repeat(mesh.areas, 3), len(vertices))
    for axis in range(3):
        target[:, axis] = np.bincount(faces.ravel(), np.repeat(weighted[:, axis], 3), len(vertices))
    step = target / total[:, None] - vertices
    step -= mesh.vertex_normals * (step * mesh.vertex_normals).sum(axis=1, keepdims=True)
    along = np.zeros((len(vertices), 3))
    np.add.at(along, boundary, 0.25 * (vertices[boundary[:, ::-1]] - vertices[boundary]))
    step[boundary[:, 0]] = along[boundary[:, 0]]
    return vertices + step


def _project(
    points: Floats, boundary: Integers, implicit: Implicit, floor: float | None, steps: int, reach: float
) -> Floats:
    """Newton's steps, none over `reach`, onto {implicit = 0}, inside the plane z = floor for boundary vertices."""
    delta = 1e-6
    for _ in range(steps):
        value = implicit(points)
        gradient = np.stack([(implicit(points + delta * axis) - value) / delta for axis in np.eye(3)], axis=1)
        if floor is not None:
            gradient[boundary, 2] = 0.0
        step = gradient * (value / np.maximum((gradient**2).sum(axis=1), 1e-12))[:, None]
        length = np.linalg.norm(step, axis=1, keepdims=True)
        points = points - step * np.minimum(1.0, reach / np.maximum(length, 1e-12))
    if floor is not None:
        points[boundary, 2] = floor
    return points
