"""Flat rectangle and flat torus."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.flat_shapes import Rectangle
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.shapes.torus import periodic_grid_faces
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh


def grid_faces(rows: int, columns: int) -> Integers:
    """Faces of an open grid of rows x columns vertices with alternating diagonals; vertex (i, j) is i * columns + j."""
    i, j = (index.ravel() for index in np.meshgrid(np.arange(rows - 1), np.arange(columns - 1), indexing="ij"))
    a, b, c, d = i * columns + j, (i + 1) * columns + j, (i + 1) * columns + j + 1, i * columns + j + 1
    even = ((i + j) % 2 == 0)[:, None]
    falling, rising = np.stack([a, b, c, a, c, d], axis=1), np.stack([a, b, d, b, c, d], axis=1)
    return np.where(even, falling, rising).reshape(-1, 3)


def rectangle(n_x: int = 61, n_y: int = 41, width: float = 2.1**0.5, height: float = 1.0) -> Surface:
    """Rectangle [0, width] x [0, height] in the plane z = 0, normal +z, of n_x * n_y vertices.

    Returns
    -------
    Surface
        `coordinates` are (x, y).

    Raises
    ------
    ValueError
        If a count is under 2 or a side not positive.
    """
    if min(n_x, n_y) < 2 or min(width, height) <= 0:
        raise ValueError(
            f"rectangle has {n_x} x {n_y} vertices, sides {width}, {height}; from 2 x 2 and above 0 are needed"
        )
    x, y = np.meshgrid(np.linspace(0.0, width, n_x), np.linspace(0.0, height, n_y), indexing="ij")
    vertices = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    mesh, shape = TriangleMesh(vertices, grid_faces(n_x, n_y)), Rectangle(width, height)
    return with_metrics(Surface(mesh, name="rectangle", coordinates=vertices[:, :2], shape=shape))


def flat_torus(n: int = 24, equilateral: bool = False) -> tuple[Integers, Floats]:
    """The flat torus of n x n vertices, which has no embedding: faces, and their corners in the plane.

    Parameters
    ----------
    n : int
        Vertices along each period, at least 3.
    equilateral : bool
        The hexagonal lattice (1, 0), (-1/2, sqrt(3)/2) of equilateral triangles instead of the square one.

    Returns
    -------
    faces : (2 n^2, 3) int64
    corners : (2 n^2, 3, 2) float64
        Positions of the corners, each face unwrapped across the periods.

    Raises
    ------
    ValueError
        If n is under 3.
    """
    if n < 3:
        raise ValueError(f"flat_torus has n = {n}; at least 3 are needed")
    faces = periodic_grid_faces(n, n)
    cell = np.stack(np.divmod(faces, n), axis=2) / n
    offset = cell - cell[:, :1]
    corners = cell[:, :1] + offset - np.round(offset)
    lattice = np.array([[1.0, 0.0], [-0.5, 0.75**0.5] if equilateral else [0.0, 1.0]])
    return faces, corners @ lattice
