"""The flat disk, on concentric rings."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Integers
from surfexp.mesh.flat_shapes import Disk
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh


def ring_faces(rings: int) -> Integers:
    """(6 rings^2, 3) faces of a disk whose ring k has 6 k vertices; vertex 0 is the centre."""
    faces = []
    for ring in range(1, rings + 1):
        inner, outer = 1 + 3 * (ring - 1) * (ring - 2), 1 + 3 * ring * (ring - 1)
        inner_count, outer_count = max(6 * (ring - 1), 1), 6 * ring
        if ring == 1:
            inner = 0
        step = np.arange(outer_count)
        # each outer edge sees the inner vertex nearest in angle; each inner edge the outer vertex between its ends
        apex = inner + (step - step // ring) % inner_count
        faces.append(np.stack([apex, outer + step, outer + (step + 1) % outer_count], axis=1))
        if ring > 1:
            step = np.arange(inner_count)
            tip = outer + (step + step // (ring - 1) + 1) % outer_count
            faces.append(np.stack([inner + step, tip, inner + (step + 1) % inner_count], axis=1))
    return np.concatenate(faces)


def disk(rings: int = 30, radius: float = 1.0) -> Surface:
    """Disk in the plane z = 0, normal +z, of 1 + 3 rings (rings + 1) vertices with its rim exactly on the circle.

    Returns
    -------
    Surface
        `coordinates` are (rho, angle).

    Raises
    ------
    ValueError
        If there is no ring or the radius is not positive.
    """
    if rings < 1 or radius <= 0:
        raise ValueError(f"disk has rings = {rings}, radius = {radius}; rings >= 1 and radius > 0 are needed")
    rho, angle = ring_coordinates(rings)
    vertices = radius * np.stack([rho * np.cos(angle), rho * np.sin(angle), np.zeros_like(rho)], axis=1)
    mesh = TriangleMesh(vertices, ring_faces(rings))
    polar = np.stack([radius * rho, angle], axis=1)
    return with_metrics(Surface(mesh, name="disk", coordinates=polar, shape=Disk(radius)))


def ring_coordinates(rings: int) -> tuple[np.ndarray, np.ndarray]:
    """Radius (0..1) and angle in [0, 2 pi) of the vertices that `ring_faces` joins."""
    ring = np.repeat(np.arange(rings + 1), np.maximum(6 * np.arange(rings + 1), 1))
    position = np.concatenate([np.arange(max(6 * k, 1)) for k in range(rings + 1)])
    return ring / rings, np.pi / 3.0 * position / np.maximum(ring, 1)
