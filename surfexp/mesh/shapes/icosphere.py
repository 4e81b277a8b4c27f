"""The geodesic icosphere: an icosahedron subdivided and projected onto the sphere."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.curved_shapes import Sphere
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.subdivision import subdivide
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh

GOLDEN = (1.0 + 5.0**0.5) / 2.0
# fmt: off
ICOSAHEDRON_FACES = [
    [0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11], [1, 5, 9], [5, 11, 4], [11, 10, 2], [10, 7, 6], [7, 1, 8],
    [3, 9, 4], [3, 4, 2], [3, 2, 6], [3, 6, 8], [3, 8, 9], [4, 9, 5], [2, 4, 11], [6, 2, 10], [8, 6, 7], [9, 8, 1],
]
# fmt: on
# 10,485,762 vertices
MOST_LEVELS = 10


def spherical_coordinates(points: Floats) -> Floats:
    """(n, 2) longitude in (-pi, pi] and latitude in [-pi/2, pi/2] of points around the origin."""
    x, y, z = points.T
    return np.stack([np.arctan2(y, x), np.arctan2(z, np.hypot(x, y))], axis=1)


def icosphere(levels: int = 4, radius: float = 1.0) -> Surface:
    """Sphere of 10 * 4^levels + 2 vertices, all of them exactly on it; the triangles are nearly equilateral.

    Raises
    ------
    ValueError
        If `levels` is not within 0 to 10 or the radius not positive.
    """
    if not 0 <= levels <= MOST_LEVELS or radius <= 0:
        raise ValueError(
            f"icosphere has levels = {levels}, radius = {radius}; 0 <= levels <= {MOST_LEVELS} and radius > 0 are needed"
        )
    signs = np.array([[-1, 1], [1, 1], [-1, -1], [1, -1]], dtype=float) * [1.0, GOLDEN]
    zero = np.zeros((4, 1))
    corners = np.concatenate(
        [np.hstack([signs, zero]), np.hstack([zero, signs]), np.hstack([signs, zero])[:, [1, 2, 0]]]
    )

    def onto_sphere(points: Floats) -> Floats:
        return points * (radius / np.linalg.norm(points, axis=1, keepdims=True))

    mesh = TriangleMesh(onto_sphere(corners), np.array(ICOSAHEDRON_FACES))
    mesh = subdivide(mesh, onto_sphere, levels)
    longitude_latitude = spherical_coordinates(mesh.vertices)
    return with_metrics(Surface(mesh, name="sphere", coordinates=longitude_latitude, shape=Sphere(radius)))
