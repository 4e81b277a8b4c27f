"""Total variation held against perimeters: theorems 2.2.1 to 2.2.3, by routes that share no gradient."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.triangle_mesh import TriangleMesh


def level_line_length(mesh: TriangleMesh, values: Floats, level: float) -> float:
    """Return the length of {f = t} of a function linear on every face, from the points where it crosses edges.

    Parameters
    ----------
    mesh : TriangleMesh
    values : (n,) float64
        f at the vertices, none of them equal to the level.
    level : float
    """
    above = values[mesh.faces] > level
    crossed = (above.sum(axis=1) == 1) | (above.sum(axis=1) == 2)
    faces, above = mesh.faces[crossed], above[crossed]
    # the vertex that lies alone on its side of the line
    alone = np.argmax(above == (above.sum(axis=1) == 1)[:, None], axis=1)
    rows = np.arange(len(faces))
    ends = []
    for turn in (1, 2):
        start, stop = faces[rows, alone], faces[rows, (alone + turn) % 3]
        share = (level - values[start]) / (values[stop] - values[start])
        ends.append(mesh.vertices[start] + share[:, None] * (mesh.vertices[stop] - mesh.vertices[start]))
    return float(np.linalg.norm(ends[1] - ends[0], axis=1).sum())


def integral_of_perimeters(mesh: TriangleMesh, values: Floats) -> float:
    """Return the integral over t of the length of {f = t} (2.3), exact for a function linear on every face.

    Between neighbouring values at the vertices the length is linear in t, so that the midpoint rule is exact.

    Parameters
    ----------
    mesh : TriangleMesh
    values : (n,) float64
    """
    knots = np.unique(values)
    middles, steps = 0.5 * (knots[1:] + knots[:-1]), np.diff(knots)
    return float(sum(step * level_line_length(mesh, values, t) for t, step in zip(middles, steps, strict=True)))


def jump_variation(mesh: TriangleMesh, values: Floats) -> float:
    """Return the total variation of a function constant on every face: jumps times the lengths of the edges between.

    Parameters
    ----------
    mesh : TriangleMesh
    values : (m,) float64
        One value a face.
    """
    lengths, pairs = _inner_edges(mesh)
    return float(lengths @ np.abs(values[pairs[:, 1]] - values[pairs[:, 0]]))


def integral_of_face_perimeters(mesh: TriangleMesh, values: Floats) -> float:
    """Return the integral over t of the perimeter of the union of the faces on which a function exceeds t (2.4).

    Parameters
    ----------
    mesh : TriangleMesh
    values : (m,) float64
        One value a face.
    """
    lengths, pairs = _inner_edges(mesh)
    knots = np.unique(values)
    total = 0.0
    for low, high in pairwise(knots):
        inside = values > low
        total += (high - low) * float(lengths[inside[pairs[:, 0]] != inside[pairs[:, 1]]].sum())
    return total


def _inner_edges(mesh: TriangleMesh) -> tuple[Floats, np.ndarray]:
    """(e,) lengths of the edges between two faces, and (e, 2) these faces."""
    order = mesh.edge_table.half_edges
    edges, faces = mesh.edge_table.edge_of[order], order // 3
    first = np.flatnonzero(edges[1:] == edges[:-1])
    ends = mesh.vertices[mesh.edges[edges[first]]]
    return np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1), np.stack([faces[first], faces[first + 1]], axis=1)
