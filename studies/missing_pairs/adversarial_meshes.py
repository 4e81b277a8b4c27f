"""Meshes on which eigensolvers are tried: two equal pieces, triangles that are nearly lines."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh

CLEARANCE = 1.5


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
