"""Fewer vertices: edges are contracted, the shortest first."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from surfexp.mesh.edge_operations import collapse_edges, flip_edges
from surfexp.mesh.masked_surface import cut_to_mask
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh

ROUGHNESS = 0.05
ROUNDS = 60


def coarse(surface: Surface, count: int, seed: int = 0, thinnest: float | None = None) -> Surface:
    """Contract edges, the shortest first, until `count` vertices are left; the seed decides which are short.

    Parameters
    ----------
    surface : Surface
    count : int
        Vertices that stay.
    seed : int
        Of the noise of a twentieth of the edge length that is put on the vertices first.
    thinnest : float, optional
        Cut away where the map "thickness" of the surface is less: the medial wall of a cortex. The largest piece stays.

    Raises
    ------
    ValueError
        If the number of vertices cannot be reached, or there is no thickness.
    """
    if thinnest is not None:
        if "thickness" not in surface.scalars:
            raise ValueError(f"{surface.name} has no map 'thickness', by which its medial wall could be cut away")
        surface = cut_to_mask(surface, _largest_piece(surface.mesh, surface.scalars["thickness"] >= thinnest))
    mesh, rng = surface.mesh, np.random.default_rng(seed)
    vertices = mesh.vertices + ROUGHNESS * mesh.edge_length * rng.standard_normal(mesh.vertices.shape)
    faces, longest = np.array(mesh.faces), 3.0 * float(np.sqrt(2.0 * mesh.area / (np.sqrt(3.0) * count)))
    for _ in range(ROUNDS):
        if len(vertices) <= count:
            break
        vertices, faces = collapse_edges(vertices, faces, np.inf, longest, len(vertices) - count)
        faces = flip_edges(vertices, faces)[0]
    if len(vertices) != count:
        raise ValueError(f"{surface.name} stays at {len(vertices)} vertices, {count} were asked for")
    return Surface(TriangleMesh(vertices, faces), surface.name, surface.unit)


def _largest_piece(mesh: TriangleMesh, kept: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Keep the largest connected piece of what is kept."""
    inside = kept[mesh.faces].all(axis=1)
    labels = TriangleMesh(mesh.vertices, mesh.faces[inside]).component_labels
    used = np.unique(mesh.faces[inside])
    largest = np.bincount(labels[used]).argmax()
    piece = np.zeros(len(kept), bool)
    piece[used[labels[used] == largest]] = True
    return piece
