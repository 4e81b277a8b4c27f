"""Initial curves for segmentation and for flows: circles about random vertices, and caps."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.triangle_mesh import TriangleMesh


def disc_distance(mesh: TriangleMesh, discs: int, radius: float, seed: int = 0) -> Floats:
    """Return a level function, positive in discs about random vertices, whose zero line is the initial curve.

    Parameters
    ----------
    mesh : TriangleMesh
    discs : int
        Their number, from 1 to the number of vertices.
    radius : float
        In the unit of the mesh; distances are those in space.
    seed : int

    Returns
    -------
    (n,) float64
        Radius less the distance from the nearest centre.

    Raises
    ------
    ValueError
        If there are more discs than vertices or none, or the discs are empty or cover the surface.
    """
    count = len(mesh.vertices)
    if not 1 <= discs <= count:
        raise ValueError(f"initial curve has {discs} discs; 1..{count} are possible on this surface")
    centres = mesh.vertices[np.random.default_rng(seed).choice(count, discs, replace=False)]
    nearest = np.full(count, np.inf)
    for centre in centres:
        np.minimum(nearest, np.linalg.norm(mesh.vertices - centre, axis=1), out=nearest)
    if not 0 < radius < nearest.max():
        raise ValueError(f"initial discs have radius {radius}, must lie in (0, {nearest.max():.3g}) on this surface")
    return radius - nearest


def angular_distance(mesh: TriangleMesh, direction: Floats) -> Floats:
    """Return the angle in radians, seen from the centre of area, between each vertex and a direction.

    On a sphere of radius 1 it is the geodesic distance from the pole in that direction.

    Raises
    ------
    ValueError
        If the direction has length 0.
    """
    length = float(np.linalg.norm(direction))
    if length == 0:
        raise ValueError("direction is (0, 0, 0), an axis needs a length")
    rays = mesh.vertices - mesh.vertex_areas @ mesh.vertices / mesh.area
    sine = np.linalg.norm(np.cross(rays, direction), axis=1)
    angles: Floats = np.arctan2(sine, rays @ direction)
    return angles
