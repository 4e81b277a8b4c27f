"""Lengths of sulci: geodesics between the ends of a region, found on the surface itself or carried over by a map."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats, Integers
from surfexp.extras import require_installed
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.elements_surface import surface_elements
from surfexp.spectrum.eigensolver import eigenpairs


def region_mesh(mesh: TriangleMesh, inside: NDArray[np.bool_]) -> tuple[TriangleMesh, Integers]:
    """Return the largest piece of the faces whose corners are all inside, and the vertices that it consists of."""
    faces = mesh.faces[np.asarray(inside, dtype=bool)[mesh.faces].all(axis=1)]
    if not len(faces):
        raise ValueError(f"the region of {int(np.sum(inside))} vertices has no whole face")
    part = TriangleMesh(mesh.vertices, faces)
    labels = part.component_labels[faces[:, 0]]
    faces = faces[labels == np.argmax(np.bincount(labels, part.areas))]
    kept = np.unique(faces)
    return TriangleMesh(mesh.vertices[kept], np.searchsorted(kept, faces)), kept


def closed_region(mesh: TriangleMesh, inside: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return a region grown by one ring of edges and shrunk by one, which closes gaps of the width of an edge."""
    first, second = mesh.edges.T
    inside = np.asarray(inside, dtype=bool)
    grown = inside.copy()
    grown[first[inside[second]]] = True
    grown[second[inside[first]]] = True
    shrunk = grown.copy()
    shrunk[first[~grown[second]]] = False
    shrunk[second[~grown[first]]] = False
    return shrunk


def region_ends(mesh: TriangleMesh, inside: NDArray[np.bool_]) -> tuple[int, int]:
    """Return the vertices at which the first eigenfunction of a region (free boundary) is least and largest."""
    part, kept = region_mesh(mesh, inside)
    elements = surface_elements(part)
    first = eigenpairs(elements.stiffness, elements.mass, 2, method="dense").vectors[:, 1]
    return int(kept[first.argmin()]), int(kept[first.argmax()])


def geodesic_lengths(mesh: TriangleMesh, pairs: Sequence[tuple[int, int]]) -> list[float]:
    """Return the exact length of the shortest way on the triangles between the vertices of each pair."""
    require_installed("the exact geodesic distance", "pygeodesic")
    from pygeodesic.geodesic import PyGeodesicAlgorithmExact

    exact = PyGeodesicAlgorithmExact(np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int32))
    return [0.0 if start == end else float(exact.geodesicDistance(start, end)[0]) for start, end in pairs]


def carried_vertex(points: Floats, place: Floats) -> int:
    """Return the row of `points` that is nearest to one place.

    Parameters
    ----------
    points : (t, 3) float64
        The place on the template to which each target vertex is mapped.
    place : (3,) float64
        What is looked for on the template.
    """
    return int(np.argmin(((points - place) ** 2).sum(axis=1)))


def carried_ends(template: TriangleMesh, rows: Integers, ends: tuple[int, int]) -> tuple[int, int]:
    """Return the target vertices that a map sends nearest to two template vertices.

    Parameters
    ----------
    rows : (t,) int64
        Template vertex of each target vertex.
    ends : tuple of int
        Template vertices.
    """
    places = template.vertices[rows]
    start, end = (carried_vertex(places, template.vertices[vertex]) for vertex in ends)
    return start, end
