"""Implicit surfaces: smooth set operations on distance-like functions, and their meshes."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.extras import require_installed
from surfexp.mesh.remeshing import Implicit, remesh
from surfexp.mesh.triangle_mesh import TriangleMesh


def smooth_union(first: Floats, second: Floats, width: float) -> Floats:
    """Minimum of two functions, rounded where they differ by less than `width` and exact elsewhere."""
    overlap = np.maximum(width - np.abs(first - second), 0.0)
    return np.minimum(first, second) - overlap**2 / (4.0 * width)


def smooth_intersection(first: Floats, second: Floats, width: float) -> Floats:
    """Maximum of two functions, rounded where they differ by less than `width` and exact elsewhere."""
    return -smooth_union(-first, -second, width)


def marching_cubes(implicit: Implicit, lower: Floats, upper: Floats, spacing: float) -> tuple[Floats, Integers]:
    """Vertices and outward faces of {implicit = 0} in a box; open where the surface leaves the box."""
    require_installed("marching cubes", "skimage")
    from skimage.measure import marching_cubes as lewiner

    shape = np.ceil((upper - lower) / spacing).astype(int) + 1
    steps = (upper - lower) / (shape - 1)
    axes = [lower[k] + steps[k] * np.arange(shape[k]) for k in range(3)]
    slabs = [
        implicit(np.stack(np.meshgrid(x, axes[1], axes[2], indexing="ij"), axis=-1).reshape(-1, 3))
        for x in axes[0][:, None]
    ]
    values = np.stack(slabs).reshape(shape)
    # a level set through grid nodes makes faces without area
    values = np.where(np.abs(values) < 0.02 * spacing, np.where(values < 0, -0.02, 0.02) * spacing, values)
    vertices, faces, _, _ = lewiner(values, 0.0, spacing=tuple(steps))
    return vertices.astype(np.float64) + lower, faces.astype(np.int64)


def mesh_implicit(
    implicit: Implicit, lower: list[float], upper: list[float], spacing: float, count: int, open_floor: bool = False
) -> TriangleMesh:
    """Mesh of {implicit = 0} inside a box with exactly `count` vertices and nearly equilateral triangles.

    Parameters
    ----------
    implicit : callable
        (n, 3) points to (n,) values, negative inside, with a gradient of about unit length near the surface.
    lower, upper : (3,)
        The box. The surface may leave it through the face z = lower[2] only, and then `open_floor` is true.
    spacing : float
        Step of the marching-cubes grid; it has to resolve the topology.
    count : int
        Number of vertices.
    """
    vertices, faces = marching_cubes(implicit, np.array(lower), np.array(upper), spacing)
    return remesh(vertices, faces, implicit, count, lower[2] if open_floor else None)
