"""Drums of seven equal tiles, meshed tile by tile so that isospectral pairs have equal discrete spectra."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from surfexp.contract.arrays import Floats, Integers
from surfexp.operators.elements_nodes import flat_positions, number_nodes
from surfexp.operators.elements_surface import Boundary, SurfaceElements, assemble_elements
from surfexp.studies.drums.transplantation_pairs import TILES, Gluing

ON_SIDE = 1e-12
RIGHT_ISOSCELES = np.array([[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]])
# Dirichlet eigenvalues of the Gordon-Webb-Wolpert drums with a right isosceles tile of legs 2 (Driscoll 1997)
GORDON_WEBB_WOLPERT_VALUES = (
    *(2.53794399980, 3.65550971352, 5.17555935622, 6.53755744376, 7.24807786256),
    *(9.20929499840, 10.5969856913, 11.5413953956, 12.3370055014, 13.0536540557),
)


@dataclass(frozen=True, eq=False)
class Drum:
    """A glued drum.

    Parameters
    ----------
    faces : (7 m, 3) int64
        Faces of the tiles one after another, over the glued vertices.
    corners : (7 m, 3, 2) float64
        Their corners in the plane. Odd tiles are mirror images. Tiles that overlap in the plane stay apart in `faces`.
    vertices : (n, 2) float64
        Places of the vertices.
    tiles : (7, 3, 2) float64
        The corners of the tiles.
    """

    faces: Integers
    corners: Floats
    vertices: Floats
    tiles: Floats


def tile_mesh(divisions: int, grading: float = 2.0) -> tuple[Floats, Integers]:
    """Barycentric coordinates and faces of a triangle cut into divisions^2 smaller ones.

    Parameters
    ----------
    divisions : int
    grading : float
        Exponent by which the nodes are drawn to the corners, where eigenfunctions of a drum are singular; 1 is uniform.
    """
    if divisions < 1 or grading < 1:
        raise ValueError(f"tile has divisions = {divisions}, grading = {grading}; both must be at least 1")
    index: dict[tuple[int, int], int] = {}
    for i in range(divisions + 1):
        for j in range(divisions + 1 - i):
            index[i, j] = len(index)
    points = np.array([(divisions - i - j, i, j) for i, j in index]) / divisions
    faces = []
    for i in range(divisions):
        for j in range(divisions - i):
            faces.append((index[i, j], index[i + 1, j], index[i, j + 1]))
            if i + j < divisions - 1:
                faces.append((index[i + 1, j], index[i + 1, j + 1], index[i, j + 1]))
    for corner in range(3):
        distance = 2.0 * (1.0 - points[:, corner])
        near = (distance < 1.0) & (distance > 0.0)
        offset = points[near] - np.eye(3)[corner]
        points[near] = np.eye(3)[corner] + offset * distance[near, None] ** (grading - 1.0)
    return points, np.array(faces)


def glued_drum(gluing: Gluing, triangle: Floats, barycentric: Floats, faces: Integers) -> Drum:
    """Glue seven copies of a meshed triangle.

    Parameters
    ----------
    gluing : three permutations
        Side s, opposite to corner s, of tile t is joined to that of tile gluing[s][t].
    triangle : (3, 2) float64
        Corners of the tile.
    barycentric, faces
        The mesh of the tile, for example from `tile_mesh`.

    Raises
    ------
    ValueError
        If the triangle has no area.
    """
    if abs(np.linalg.det(triangle[1:] - triangle[0])) <= 1e-12 * np.abs(np.ptp(triangle, axis=0)).max() ** 2:
        raise ValueError("the corners of the tile lie on a line, its area must be positive")
    count = len(barycentric)
    left, right = [], []
    for side, permutation in enumerate(gluing):
        on_side = np.flatnonzero(barycentric[:, side] < ON_SIDE)
        for tile in range(TILES):
            left.append(tile * count + on_side)
            right.append(permutation[tile] * count + on_side)
    pairs = np.concatenate(left), np.concatenate(right)
    same = coo_array((np.ones(len(pairs[0])), pairs), shape=(TILES * count,) * 2)
    number = connected_components(same, directed=False)[1].astype(np.int64)
    tiles = tile_layout(gluing, triangle)
    places = np.einsum("bk,tkd->tbd", barycentric, tiles)
    vertices = np.zeros((int(number.max()) + 1, 2))
    vertices[number] = places.reshape(-1, 2)
    return Drum(
        faces=np.concatenate([number[tile * count + faces] for tile in range(TILES)]),
        corners=places[:, faces].reshape(-1, 3, 2),
        vertices=vertices,
        tiles=tiles,
    )


def tile_layout(gluing: Gluing, triangle: Floats) -> Floats:
    """(7, 3, 2) corners of the tiles in the plane, each the mirror image of its neighbour in their common side."""
    placed, order = {0: np.array(triangle, dtype=np.float64)}, [0]
    for tile in order:
        for side, permutation in enumerate(gluing):
            if permutation[tile] not in placed:
                corners = placed[tile].copy()
                start, end = corners[(side + 1) % 3], corners[(side + 2) % 3]
                along = (end - start) / np.linalg.norm(end - start)
                offset = corners[side] - start
                corners[side] = start + 2.0 * (offset @ along) * along - offset
                placed[permutation[tile]] = corners
                order.append(permutation[tile])
    return np.stack([placed[tile] for tile in range(TILES)])


def drum_elements(drum: Drum, order: int = 1, boundary: Boundary = "dirichlet") -> SurfaceElements:
    """Assemble the Laplacian of a drum with elements of the given order."""
    nodes = number_nodes(drum.faces, len(drum.vertices), order)
    return assemble_elements(nodes, flat_positions(drum.corners, order), boundary=boundary)
