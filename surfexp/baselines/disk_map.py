"""Maps of a disk-like patch to the plane."""

from __future__ import annotations

from typing import Literal

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.triangle_mesh import TriangleMesh


def disk_map(mesh: TriangleMesh, boundary: Literal["free", "circle"] = "free") -> Floats:
    """Map a topological disk to the plane.

    Parameters
    ----------
    mesh : TriangleMesh
    boundary : {"free", "circle"}
        "free" is the least-squares conformal map (Levy et al. 2002): angles are kept, the outline follows, two boundary
        vertices are held. "circle" is the harmonic map with the boundary on the unit circle by arc length: one-to-one
        where the cotangents are positive, with angles lost near the boundary.

    Returns
    -------
    (n, 2) float64
        Counter-clockwise as the mesh, scaled to the area of the mesh.

    Raises
    ------
    ValueError
        If the mesh is not a topological disk.
    """
    import igl

    loop = boundary_of_disk(mesh)
    length = np.linalg.norm(np.diff(mesh.vertices[np.append(loop, loop[0])], axis=0), axis=1)
    turn = np.concatenate([[0.0], np.cumsum(length)[:-1]]) / length.sum()
    if boundary == "circle":
        angle = 2 * np.pi * turn
        circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        plane = igl.harmonic(mesh.vertices, mesh.faces, loop, circle, 1)
    else:
        held = loop[[0, int(np.searchsorted(turn, 0.5)) % len(loop)]]
        plane, _ = igl.lscm(mesh.vertices, mesh.faces, held, np.array([[0.0, 0.0], [1.0, 0.0]]))
    return _scaled(mesh, plane)


def boundary_of_disk(mesh: TriangleMesh) -> Integers:
    """Return the boundary loop of a topological disk.

    Raises
    ------
    ValueError
        If the mesh is not a topological disk.
    """
    loops = len(mesh.boundary_loops)
    if mesh.euler_characteristic != 1 or loops != 1 or mesh.component_count != 1:
        raise ValueError(
            f"patch has {loops} boundary loops, {mesh.component_count} components and Euler characteristic "
            f"{mesh.euler_characteristic}, a disk has 1, 1 and 1; cut it by patchwise"
        )
    return mesh.boundary_loops[0]


def _scaled(mesh: TriangleMesh, plane: Floats) -> Floats:
    a, b, c = (plane[mesh.faces[:, k]] for k in range(3))
    u, v = b - a, c - a
    area = 0.5 * float((u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum())
    return plane * np.sqrt(mesh.area / area)
