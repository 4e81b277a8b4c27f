"""Surfaces on which the published spectral distance fails to be a metric."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.surface_of_revolution import PROFILES, surface_of_revolution
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh

NAMES = (*PROFILES, "needle_ball", "two_balls")
BALL, NEEDLE, HALF_LENGTH = 0.9, 0.02, 3.0


def needle_ball(t: Floats) -> Floats:
    """A ball with a long thin needle on either side: nearly all area in the middle of the range of phi_1."""
    z = -HALF_LENGTH * np.cos(t)
    ball = np.sqrt(np.maximum(BALL**2 - z**2, 0.0))
    return np.asarray(np.maximum(ball, NEEDLE) * _closing(t))


def two_balls(t: Floats) -> Floats:
    """Two balls on a thin tube: nearly all area at the ends of the range of phi_1."""
    z = np.abs(-HALF_LENGTH * np.cos(t))
    centre = HALF_LENGTH - BALL
    ball = np.sqrt(np.maximum(BALL**2 - (z - centre) ** 2, 0.0))
    return np.asarray(np.maximum(ball, 6.0 * NEEDLE * (z < centre)) * _closing(t))


def _closing(t: Floats) -> Floats:
    return np.minimum(1.0, 20.0 * np.sin(t)) ** 0.5


def named_revolution(profile: str, rows: int = 120, columns: int = 32) -> Surface:
    """Return a surface of revolution by name: those of `surface_of_revolution`, "needle_ball" and "two_balls"."""
    if profile not in NAMES:
        raise ValueError(f"profile {profile!r} is unknown, choose one of {', '.join(NAMES)}")
    own = {"needle_ball": needle_ball, "two_balls": two_balls}.get(profile)
    if own is None:
        return surface_of_revolution(profile, rows, columns)
    surface = surface_of_revolution(own, rows, columns, HALF_LENGTH)
    return Surface(surface.mesh, profile.replace("_", " "), coordinates=surface.coordinates, metrics=surface.metrics)


def clover(levels: int = 4, lobes: int = 3, depth: float = 0.35, squeeze: float = 0.0, angle: float = 0.0) -> Surface:
    """A flat body with `lobes` equal lobes, whose first eigenvalue is double, squeezed a little in one direction.

    Squeezed, the double eigenvalue splits, and the direction decides which two functions are left: surfaces that are
    near to each other have eigenfunctions that are not.

    Parameters
    ----------
    levels : int
        Subdivisions of the icosahedron.
    lobes : int
        At least 3.
    depth : float
        Of the notches between them, as a share of the radius, below 1.
    squeeze : float
        Share by which the body is shortened in the direction `angle` (degrees).
    """
    if lobes < 3 or not 0 <= depth < 1 or not 0 <= squeeze < 0.5:
        raise ValueError(
            f"clover has lobes {lobes}, depth {depth:g}, squeeze {squeeze:g}; >= 3, 0..1, 0..0.5 are needed"
        )
    mesh = icosphere(levels).mesh
    x, y, z = mesh.vertices.T
    flat = np.hypot(x, y)
    radius = 1.0 + depth * flat**lobes * np.cos(lobes * np.arctan2(y, x))
    body = np.stack([x * radius, y * radius, 0.45 * z], axis=1)
    direction = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle)), 0.0])
    body -= squeeze * np.outer(body @ direction, direction)
    name = f"clover of {lobes} lobes" + (f", squeezed by {squeeze:g} at {angle:g} degrees" if squeeze else "")
    return with_metrics(Surface(TriangleMesh(body, mesh.faces), name=name))
