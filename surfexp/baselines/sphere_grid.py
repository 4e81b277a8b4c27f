"""A regular longitude-latitude grid on the sphere as parameter domain of a genus-0 surface."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from surfexp.baselines.parameter_domain import ParameterDomain, image_mesh, reweighted
from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import fem


def sphere_grid_domain(mesh: TriangleMesh, positions: Floats, columns: int = 512, rows: int = 256) -> ParameterDomain:
    """Resample a surface on a regular grid of its spherical image.

    Every grid point takes its values from the spherical triangle in which it lies, every vertex takes its result from
    the grid triangle in which it lies, and the area of a grid triangle on the surface follows from the conformal
    factors at its corners. Detail between grid points is lost: `grid_separation` says how much.

    Parameters
    ----------
    mesh : TriangleMesh
    positions : (n, 3) float64
        Image of each vertex on the unit sphere.
    columns, rows : int
        Grid points along a parallel and along a meridian.

    Raises
    ------
    ValueError
        If there are fewer than 3 columns or 1 row.
    """
    sphere = image_mesh(mesh, positions)
    grid = longitude_latitude_mesh(columns, rows)
    to_domain, face = _barycentric_matrix(sphere, grid.vertices)
    to_vertices, _ = _barycentric_matrix(grid, positions)
    factor = (mesh.areas / sphere.areas)[face]
    operator = fem(grid)
    weighted = reweighted(operator, operator.areas * factor[grid.faces].mean(axis=1))
    metrics = {
        "grid_separation": grid_separation(positions, columns, rows),
        "area_ratio": float(weighted.areas.sum() / mesh.area),
    }
    return ParameterDomain(weighted, to_domain, to_vertices, False, f"conformal grid {columns}x{rows}", metrics)


def longitude_latitude_mesh(columns: int, rows: int) -> TriangleMesh:
    """Return the unit sphere over the centres of a regular grid of longitudes and polar angles, closed by two poles.

    Raises
    ------
    ValueError
        If there are fewer than 3 columns or 1 row.
    """
    if columns < 3 or rows < 1:
        raise ValueError(f"grid of {columns} x {rows} points on the sphere is too small, at least 3 x 1 are needed")
    polar, longitude = np.meshgrid(
        (np.arange(rows) + 0.5) * np.pi / rows, np.arange(columns) * 2 * np.pi / columns, indexing="ij"
    )
    points = np.stack([np.sin(polar) * np.cos(longitude), np.sin(polar) * np.sin(longitude), np.cos(polar)], axis=2)
    poles = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]])
    return TriangleMesh(np.vstack([points.reshape(-1, 3), poles]), _grid_faces(columns, rows))


def grid_separation(positions: Floats, columns: int, rows: int) -> float:
    """Occupied cells over vertices: 1 when every vertex has a cell of the grid for itself.

    Parameters
    ----------
    positions : (n, 3) float64
        On the unit sphere.
    columns, rows : int
    """
    longitude = np.arctan2(positions[:, 1], positions[:, 0]) % (2 * np.pi)
    polar = np.arccos(np.clip(positions[:, 2], -1.0, 1.0))
    column = np.minimum((longitude * columns / (2 * np.pi)).astype(np.int64), columns - 1)
    row = np.minimum((polar * rows / np.pi).astype(np.int64), rows - 1)
    return len(np.unique(row * columns + column)) / len(positions)


def _grid_faces(columns: int, rows: int) -> Integers:
    index = np.arange(rows * columns).reshape(rows, columns)
    east = np.roll(index, -1, axis=1)
    a, b, c, d = (x.ravel() for x in (index[:-1], index[1:], east[1:], east[:-1]))
    north, south = (np.full(columns, rows * columns + k) for k in range(2))
    parts = ((a, b, c), (a, c, d), (north, index[0], east[0]), (south, east[-1], index[-1]))
    return np.concatenate([np.stack(part, axis=1) for part in parts])


def _barycentric_matrix(mesh: TriangleMesh, points: Floats) -> tuple[csr_array, Integers]:
    """(q, n) interpolation at the closest points of a mesh, and the (q,) faces that hold them."""
    import igl

    _, face, closest = igl.point_mesh_squared_distance(np.ascontiguousarray(points), mesh.vertices, mesh.faces)
    corners = mesh.faces[face]
    weights = igl.barycentric_coordinates(
        closest, *(np.ascontiguousarray(mesh.vertices[corners[:, c]]) for c in range(3))
    )
    weights = np.clip(weights, 0.0, 1.0)
    weights /= weights.sum(axis=1, keepdims=True)
    rows = np.arange(0, 3 * len(points) + 1, 3)
    matrix = csr_array((weights.ravel(), corners.ravel(), rows), shape=(len(points), len(mesh.vertices)))
    return matrix, face
