"""Closed surfaces of revolution of genus 0, from a profile curve."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh

PROFILES: dict[str, Callable[[Floats], Floats]] = {
    "sphere": lambda t: np.sin(t),
    "dumbbell": lambda t: np.sin(t) * (1.0 - 0.75 * np.sin(t) ** 4),
    "cigar": lambda t: 0.35 * np.sin(t) ** 0.5,
    "pear": lambda t: np.sin(t) * (0.65 - 0.3 * np.cos(t)),
}


def surface_of_revolution(
    profile: str | Callable[[Floats], Floats] = "dumbbell", rows: int = 80, columns: int = 64, half_length: float = 1.5
) -> Surface:
    """Revolve the curve (rho(t), z(t)) = (profile(t), -half_length cos t), 0 <= t <= pi, about the z axis.

    The rows lie at equal arc length along the curve. Each row is turned by half a column against the one before, so
    the triangles are nearly isosceles.

    Parameters
    ----------
    profile : str or callable
        "sphere", "dumbbell", "cigar", "pear" or a function of t, zero at both ends and positive between.
    rows, columns : int
        Circles of vertices between the poles, at least 2; vertices on each, at least 3.

    Returns
    -------
    Surface
        `coordinates` are (arc length from the lower pole, angle).

    Raises
    ------
    ValueError
        If the profile is unknown or not positive inside, or a count is too small.
    """
    if isinstance(profile, str) and profile not in PROFILES:
        raise ValueError(f"profile {profile!r} is unknown, choose one of {', '.join(PROFILES)}")
    if rows < 2 or columns < 3:
        raise ValueError(f"surface_of_revolution has {rows} rows, {columns} columns; at least 2 and 3 are needed")
    radius_at = PROFILES[profile] if isinstance(profile, str) else profile
    t = 0.5 * np.pi * (1.0 - np.cos(np.linspace(0.0, np.pi, 20001)))
    rho, z = radius_at(np.clip(t, 0.0, np.pi)), -half_length * np.cos(t)
    if rho[1:-1].min() <= 0:
        raise ValueError(f"profile has radius {rho[1:-1].min():.3g} between the poles, positive radii are needed")
    arc = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(rho), np.diff(z)))])
    station = np.linspace(0.0, arc[-1], rows + 2)
    row_rho, row_z = np.interp(station, arc, rho), np.interp(station, arc, z)
    angle = 2.0 * np.pi / columns * (np.arange(columns)[None, :] + 0.5 * (np.arange(rows) % 2)[:, None])
    ring = [
        row_rho[1:-1, None] * np.cos(angle),
        row_rho[1:-1, None] * np.sin(angle),
        np.tile(row_z[1:-1, None], columns),
    ]
    poles = np.array([[0.0, 0.0, row_z[0]], [0.0, 0.0, row_z[-1]]])
    vertices = np.concatenate([np.stack(ring, axis=2).reshape(-1, 3), poles])
    coordinates = np.stack([np.repeat(station[1:-1], columns), angle.ravel() % (2.0 * np.pi)], axis=1)
    coordinates = np.concatenate([coordinates, [[0.0, 0.0], [arc[-1], 0.0]]])
    name = profile if isinstance(profile, str) else "surface of revolution"
    return with_metrics(Surface(TriangleMesh(vertices, _faces(rows, columns)), name=name, coordinates=coordinates))


def _faces(rows: int, columns: int) -> np.ndarray:
    here = np.arange(columns)
    after, faces = (here + 1) % columns, []
    for row in range(rows - 1):
        low, high = row * columns, (row + 1) * columns
        if row % 2 == 0:
            faces += [(low + here, low + after, high + here), (low + after, high + after, high + here)]
        else:
            faces += [(low + here, low + after, high + after), (low + here, high + after, high + here)]
    south, north, last = rows * columns, rows * columns + 1, (rows - 1) * columns
    faces += [(np.full(columns, south), after, here), (np.full(columns, north), last + here, last + after)]
    return np.concatenate([np.stack(corners, axis=1) for corners in faces])
