"""The sphere through a Fibonacci spiral of points: any number of vertices, irregular on demand."""

from __future__ import annotations

import numpy as np
from scipy.spatial import ConvexHull

from surfexp.mesh.curved_shapes import Sphere
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.shapes.icosphere import GOLDEN, spherical_coordinates
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh


def fibonacci_sphere(count: int = 2562, jitter: float = 0.0, seed: int = 0, radius: float = 1.0) -> Surface:
    """Delaunay triangulation of a Fibonacci spiral on the sphere.

    Parameters
    ----------
    count : int
        Number of vertices, at least 4.
    jitter : float
        Standard deviation of a Gaussian displacement before the projection onto the sphere, in units of
        radius / sqrt(count); the distance of neighbours is about 3.5 such units.
    seed : int
    radius : float

    Raises
    ------
    ValueError
        If there are fewer than 4 vertices.
    """
    if count < 4:
        raise ValueError(f"fibonacci_sphere has count = {count}; a sphere needs at least 4 vertices")
    index = np.arange(count) + 0.5
    polar, azimuth = np.arccos(1.0 - 2.0 * index / count), 2.0 * np.pi * GOLDEN * index
    points = np.stack([np.cos(azimuth) * np.sin(polar), np.sin(azimuth) * np.sin(polar), np.cos(polar)], axis=1)
    points += np.random.default_rng(seed).normal(0.0, jitter / np.sqrt(count), points.shape)
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    faces = ConvexHull(points).simplices.astype(np.int64)
    inward = np.linalg.det(points[faces]) < 0
    faces[inward] = faces[inward][:, [0, 2, 1]]
    mesh, shape = TriangleMesh(radius * points, faces), Sphere(radius)
    return with_metrics(Surface(mesh, name="sphere", coordinates=spherical_coordinates(points), shape=shape))
