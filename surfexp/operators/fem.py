"""Piecewise linear finite elements: hat gradients of every face in its own orthonormal frame."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.surface_operator import SurfaceOperator


def fem(mesh: TriangleMesh) -> SurfaceOperator:
    """Return the linear finite element operator of a mesh.

    The frame of a face is its first side and the perpendicular to it in the plane of the face; the gradient of the hat
    function of a corner is the opposite side turned by 90 degrees over twice the area.

    Parameters
    ----------
    mesh : TriangleMesh

    Returns
    -------
    SurfaceOperator
        With `frames`; hat gradients carry the inverse unit of the mesh.

    Raises
    ------
    ValueError
        If there are no faces, a position is not finite, a face has no area, or a vertex belongs to no face.
    """
    check_mesh(mesh)
    hat_gradients, areas, frames = _face_geometry(mesh.vertices, mesh.faces)
    return SurfaceOperator(mesh.faces, hat_gradients, areas, len(mesh.vertices), frames, name="fem")


def check_mesh(mesh: TriangleMesh, flat_faces: bool = False) -> None:
    """Refuse a mesh on which the gradient is not defined; faces without area are let pass when `flat_faces`.

    Raises
    ------
    ValueError
        As `fem`.
    """
    if not len(mesh.faces):
        raise ValueError("the mesh has 0 faces, an operator needs at least 1")
    if not np.isfinite(mesh.vertices).all():
        bad = np.flatnonzero(~np.isfinite(mesh.vertices).all(axis=1))
        raise ValueError(
            f"vertex {bad[0]} is at {mesh.vertices[bad[0]]}, positions must be finite ({len(bad)} are not)"
        )
    first, count, loose, unused = _defects(mesh.vertices, mesh.faces)
    if count and not flat_faces:
        raise ValueError(
            f"face {first} has area 0, must be positive ({count} such faces): repair the mesh or use intrinsic_delaunay"
        )
    if unused:
        raise ValueError(f"vertex {loose} belongs to no face ({unused} such vertices): repair the mesh")


@njit(cache=True, nogil=True)
def _defects(vertices: Floats, faces: Integers) -> tuple[int, int, int, int]:
    """Return the first face without area and their number, the first vertex without faces and their number."""
    first, count, loose, unused = -1, 0, -1, 0
    used = np.zeros(len(vertices), np.bool_)
    for f in range(len(faces)):
        used[faces[f, 0]] = used[faces[f, 1]] = used[faces[f, 2]] = True
        a, b, c = vertices[faces[f, 0]], vertices[faces[f, 1]], vertices[faces[f, 2]]
        ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
        vx, vy, vz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        if nx * nx + ny * ny + nz * nz <= 0.0:
            first = f if count == 0 else first
            count += 1
    for v in range(len(used)):
        if not used[v]:
            loose = v if unused == 0 else loose
            unused += 1
    return first, count, loose, unused


@njit(cache=True, nogil=True)
def _face_geometry(vertices: Floats, faces: Integers) -> tuple[Floats, Floats, Floats]:
    count = len(faces)
    hat_gradients = np.empty((count, 3, 2))
    areas = np.empty(count)
    frames = np.empty((count, 2, 3))
    for f in range(count):
        a, b, c = vertices[faces[f, 0]], vertices[faces[f, 1]], vertices[faces[f, 2]]
        ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
        vx, vy, vz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        twice_area = np.sqrt(nx * nx + ny * ny + nz * nz)
        side = np.sqrt(ux * ux + uy * uy + uz * uz)
        along = (ux * vx + uy * vy + uz * vz) / side
        scale = side * twice_area
        frames[f, 0, 0], frames[f, 0, 1], frames[f, 0, 2] = ux / side, uy / side, uz / side
        frames[f, 1, 0] = (ny * uz - nz * uy) / scale
        frames[f, 1, 1] = (nz * ux - nx * uz) / scale
        frames[f, 1, 2] = (nx * uy - ny * ux) / scale
        areas[f] = 0.5 * twice_area
        hat_gradients[f, 1, 0], hat_gradients[f, 1, 1] = 1.0 / side, -along / twice_area
        hat_gradients[f, 2, 0], hat_gradients[f, 2, 1] = 0.0, side / twice_area
        hat_gradients[f, 0, 0] = -1.0 / side
        hat_gradients[f, 0, 1] = (along - side) / twice_area
    return hat_gradients, areas, frames
