"""A cap of the sphere on circles of latitude, and the whole sphere with a circle of latitude among its edges."""

from __future__ import annotations

import numpy as np

from surfexp.mesh.curved_shapes import Sphere, SphericalCap
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.shapes.disk import ring_coordinates, ring_faces
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh


def spherical_cap(angle: float = 1.0, rings: int = 30, radius: float = 1.0) -> Surface:
    """Cap of the sphere up to the polar angle `angle` about +z, with vertices exactly on it and on its rim.

    Parameters
    ----------
    angle : float
        In radians, inside (0, pi); the rim has length 2 pi radius sin(angle), the cap area 2 pi radius^2 (1 - cos(angle)).
    rings : int
        Circles of vertices; ring k has 6 k of them.

    Returns
    -------
    Surface
        `coordinates` are (polar angle, longitude).

    Raises
    ------
    ValueError
        If the angle lies outside (0, pi), there is no ring or the radius is not positive.
    """
    if not 0 < angle < np.pi or rings < 1 or radius <= 0:
        raise ValueError(
            f"spherical_cap has angle = {angle}, rings = {rings}, radius = {radius}; "
            "0 < angle < pi, rings >= 1 and radius > 0 are needed"
        )
    fraction, longitude = ring_coordinates(rings)
    polar = angle * fraction
    x, y, z = np.sin(polar) * np.cos(longitude), np.sin(polar) * np.sin(longitude), np.cos(polar)
    mesh = TriangleMesh(radius * np.stack([x, y, z], axis=1), ring_faces(rings))
    angles, shape = np.stack([polar, longitude], axis=1), SphericalCap(radius, angle)
    return with_metrics(Surface(mesh, name="spherical cap", coordinates=angles, shape=shape))


def capped_sphere(angle: float = 1.0, rings: int = 20, radius: float = 1.0) -> Surface:
    """Closed sphere made of two caps, so that the circle at polar angle `angle` runs along edges.

    The indicator of the cap on faces is then exact. Both caps have as many rings; `coordinates` are as above.
    """
    upper, lower = spherical_cap(angle, rings, radius), spherical_cap(np.pi - angle, rings, radius)
    assert upper.coordinates is not None and lower.coordinates is not None  # noqa: S101, narrows a type
    count, inner = len(upper.mesh.vertices), len(upper.mesh.vertices) - 6 * rings
    number = np.concatenate([np.arange(inner) + count, np.arange(inner, count)])
    faces = number[lower.mesh.faces[:, ::-1]]
    vertices = np.concatenate([upper.mesh.vertices, lower.mesh.vertices[:inner] * [1.0, 1.0, -1.0]])
    other = np.stack([np.pi - lower.coordinates[:inner, 0], lower.coordinates[:inner, 1]], axis=1)
    mesh = TriangleMesh(vertices, np.concatenate([upper.mesh.faces, faces]))
    angles = np.concatenate([upper.coordinates, other])
    return with_metrics(Surface(mesh, name="sphere", coordinates=angles, shape=Sphere(radius)))
