"""Meshes on which eigensolvers are tried: coarse cortices, two equal pieces, triangles that are nearly lines."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from surfexp.mesh.edge_operations import collapse_edges, flip_edges
from surfexp.mesh.masked_surface import cut_to_mask
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh

ROUGHNESS = 0.05
ROUNDS = 60
CLEARANCE = 1.5


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


def side_by_side(surface: Surface, perturbation: float = 0.0, seed: int = 0) -> Surface:
    """Put a mirrored copy beside a surface: every eigenvalue is double, or nearly so.

    Parameters
    ----------
    surface : Surface
    perturbation : float
        Standard deviation of the noise on the vertices of the copy, in diameters of the surface.
    seed : int
    """
    mesh, rng = surface.mesh, np.random.default_rng(seed)
    size = np.ptp(mesh.vertices, axis=0)
    noise = perturbation * float(np.linalg.norm(size)) * rng.standard_normal(mesh.vertices.shape)
    mirrored = mesh.vertices * [-1.0, 1.0, 1.0] + [2.0 * mesh.vertices[:, 0].max() + (CLEARANCE - 1.0) * size[0], 0, 0]
    vertices = np.concatenate([mesh.vertices, mirrored + noise])
    faces = np.concatenate([mesh.faces, mesh.faces[:, ::-1] + len(mesh.vertices)])
    return Surface(TriangleMesh(vertices, faces), f"{surface.name} twice", surface.unit)


def with_slivers(surface: Surface, angle: float, share: float = 0.02, seed: int = 0) -> Surface:
    """Flatten some triangles until their least angle is `angle`, by moving one corner towards the middle of its edge.

    Parameters
    ----------
    surface : Surface
    angle : float
        In degrees.
    share : float
        Of all triangles; no two that are flattened have a corner in common.
    seed : int

    Raises
    ------
    ValueError
        If the angle is not between 0 and 30 degrees.
    """
    if not 0 < angle <= 30:
        raise ValueError(f"angle is {angle:g} degrees, slivers have from above 0 to 30")
    mesh, rng = surface.mesh, np.random.default_rng(seed)
    vertices, taken = mesh.vertices.copy(), np.zeros(len(mesh.vertices), bool)
    on_boundary = np.zeros(len(vertices), bool)
    on_boundary[mesh.edges[mesh.edge_face_counts == 1]] = True
    wanted = max(1, round(share * len(mesh.faces)))
    for face in rng.permutation(len(mesh.faces)):
        ring = mesh.faces[face]
        if taken[ring].any() or on_boundary[ring[0]] or not wanted:
            continue
        start, stop = vertices[ring[1]], vertices[ring[2]]
        rise = vertices[ring[0]] - 0.5 * (start + stop)
        rise -= rise @ (stop - start) / ((stop - start) @ (stop - start)) * (stop - start)
        height = 0.5 * np.linalg.norm(stop - start) * np.tan(np.radians(angle))
        vertices[ring[0]] = 0.5 * (start + stop) + height * rise / np.linalg.norm(rise)
        taken[ring] = True
        wanted -= 1
    moved = TriangleMesh(vertices, mesh.faces)
    return replace(surface.deformed(moved), name=f"{surface.name} with slivers")


def _largest_piece(mesh: TriangleMesh, kept: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Keep the largest connected piece of what is kept."""
    inside = kept[mesh.faces].all(axis=1)
    labels = TriangleMesh(mesh.vertices, mesh.faces[inside]).component_labels
    used = np.unique(mesh.faces[inside])
    largest = np.bincount(labels[used]).argmax()
    piece = np.zeros(len(kept), bool)
    piece[used[labels[used] == largest]] = True
    return piece
