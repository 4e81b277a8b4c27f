"""Tetrahedral meshes as arrays: what is accepted, volumes, and the triangles of the boundary."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.given_arrays import index_array, real_array

# least volume of a tetrahedron, over the cube of its longest edge
FLATTEST = 1e-12
# the sides of a tetrahedron, outward where its volume is positive
SIDES = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])


def sound_tetrahedra(vertices: ArrayLike, tetrahedra: ArrayLike) -> tuple[Floats, Integers]:
    """Return a tetrahedral mesh with tetrahedra of positive volume, of which at most two meet at a triangle.

    Parameters
    ----------
    vertices : (n, 3) array
    tetrahedra : (m, 4) array
        In either orientation.

    Returns
    -------
    vertices : (n, 3) float64
    tetrahedra : (m, 4) int64
        Those of negative volume with two corners exchanged.

    Raises
    ------
    ValueError
        If the arrays are no such mesh: shapes, numbers, indices, flat tetrahedra, vertices without one, overlaps.
    """
    points, cells = real_array(vertices, "vertices"), index_array(tetrahedra, "tetrahedra")
    for array, what, width in ((points, "vertices", 3), (cells, "tetrahedra", 4)):
        if array.ndim != 2 or array.shape[1] != width or not len(array):
            raise ValueError(f"{what} have shape {array.shape}, (count, {width}) is needed")
    if np.isnan(points).any():
        raise ValueError(f"vertices: {int(np.isnan(points).any(axis=1).sum())} have no position, all need one")
    if cells.min() < 0 or cells.max() >= len(points):
        wrong = int(cells.min() if cells.min() < 0 else cells.max())
        raise ValueError(f"tetrahedra have the vertex {wrong}, 0 to {len(points) - 1} are there")
    unused = np.flatnonzero(np.bincount(cells.ravel(), minlength=len(points)) == 0)
    if len(unused):
        raise ValueError(f"{len(unused)} vertices belong to no tetrahedron, the first is {unused[0]}: leave them out")
    volumes = signed_volumes(points, cells)
    lengths = np.linalg.norm(points[cells[:, [0, 0, 0, 1, 1, 2]]] - points[cells[:, [1, 2, 3, 2, 3, 3]]], axis=2)
    flat = np.flatnonzero(~(np.abs(volumes) > FLATTEST * lengths.max(axis=1) ** 3))
    if len(flat):
        raise ValueError(f"{len(flat)} tetrahedra have no volume, the first is {flat[0]}: leave them out")
    cells = np.where((volumes < 0)[:, None], cells[:, [0, 2, 1, 3]], cells)
    triangles, times, turns = _triangles(cells)
    crowded = np.flatnonzero((times > 2) | ((times == 2) & (turns != 0)))
    if len(crowded):
        corners = " ".join(map(str, triangles[crowded[0]].tolist()))
        raise ValueError(
            f"tetrahedra overlap at {len(crowded)} triangles, the first has the vertices {corners}: "
            "at most two may meet there, on its two sides"
        )
    return points, cells


def signed_volumes(vertices: Floats, tetrahedra: Integers) -> Floats:
    """(m,) volumes, positive where the corners 1, 2, 3 run counterclockwise as seen from opposite the corner 0."""
    edges = vertices[tetrahedra[:, 1:]] - vertices[tetrahedra[:, :1]]
    return np.asarray(np.einsum("mi,mi->m", np.cross(edges[:, 0], edges[:, 1]), edges[:, 2]) / 6.0)


def boundary_vertices(tetrahedra: Integers) -> Integers:
    """Return the vertices of the triangles that one tetrahedron alone has, by increasing number."""
    triangles, times, _ = _triangles(tetrahedra)
    return np.unique(triangles[times == 1])


def _triangles(tetrahedra: Integers) -> tuple[Integers, Integers, Integers]:
    """Return all triangles with sorted corners, how many tetrahedra have each, and the sum of their orientations."""
    sides = tetrahedra[:, SIDES].reshape(-1, 3)
    a, b, c = sides.T
    signs = np.where(((a < b) & (b < c)) | ((b < c) & (c < a)) | ((c < a) & (a < b)), 1, -1)
    triangles, numbers = np.unique(np.sort(sides, axis=1), axis=0, return_inverse=True)
    numbers = numbers.ravel()
    return triangles, np.bincount(numbers), np.bincount(numbers, signs).astype(np.int64)
