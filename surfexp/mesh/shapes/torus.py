"""The embedded torus of revolution."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.curved_shapes import Torus
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh


def periodic_grid_faces(rows: int, columns: int) -> Integers:
    """(2 * rows * columns, 3) faces of a grid closed in both directions; vertex (i, j) is i * columns + j."""
    i, j = (index.ravel() for index in np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij"))
    below, beside = (i + 1) % rows, (j + 1) % columns
    a, b, c, d = i * columns + j, below * columns + j, below * columns + beside, i * columns + beside
    return np.stack([a, b, c, a, c, d], axis=1).reshape(-1, 3)


def torus(
    n_u: int = 405,
    n_v: int = 162,
    major_radius: float = 1.0,
    minor_radius: float = 0.4,
    jitter: float = 0.0,
    seed: int = 0,
) -> Surface:
    """Torus of revolution about the z axis, every vertex exactly on it.

    Parameters
    ----------
    n_u, n_v : int
        Vertices along the long circles (around the axis) and the short ones, at least 3 each; the default 405 x 162 makes
        square cells and 65,610 vertices (figure 2.4 has 65,536 = 256 x 256).
    major_radius, minor_radius : float
        Radius of the centre line and of the tube.
    jitter : float
        Half-width of a uniform shift of the parameters, in grid steps; under 0.25 no face turns over.
    seed : int

    Returns
    -------
    Surface
        `coordinates` are the angles (u, v) in [0, 2 pi); area 4 pi^2 R r, volume 2 pi^2 R r^2 in the limit.

    Raises
    ------
    ValueError
        If a count is under 3 or the radii do not satisfy 0 < minor < major.
    """
    if min(n_u, n_v) < 3 or not 0 < minor_radius < major_radius:
        raise ValueError(
            f"torus has {n_u} x {n_v} vertices and radii {major_radius}, {minor_radius}; "
            "at least 3 x 3 and 0 < minor < major are needed"
        )
    shift = np.random.default_rng(seed).uniform(-jitter, jitter, (2, n_u, n_v))
    step_u, step_v = 2.0 * np.pi / n_u, 2.0 * np.pi / n_v
    u = ((np.arange(n_u)[:, None] + shift[0]) * step_u).ravel()
    v = ((np.arange(n_v)[None, :] + shift[1]) * step_v).ravel()
    mesh = TriangleMesh(torus_points(u, v, major_radius, minor_radius), periodic_grid_faces(n_u, n_v))
    angles = np.stack([u, v], axis=1) % (2.0 * np.pi)
    return with_metrics(Surface(mesh, name="torus", coordinates=angles, shape=Torus(major_radius, minor_radius)))


def torus_points(u: Floats, v: Floats, major_radius: float, minor_radius: float) -> Floats:
    """(n, 3) points of the torus at the angles u around the axis and v around the tube."""
    rho = major_radius + minor_radius * np.cos(v)
    return np.stack([rho * np.cos(u), rho * np.sin(u), minor_radius * np.sin(v)], axis=1)
