"""The surface of a cube, for denoising of geometry."""

from __future__ import annotations

import numpy as np

from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.shapes.rectangle import grid_faces
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.welding import weld

# normal, and two directions whose cross product is the normal
SIDES = [(2, 0, 1, 1.0), (2, 1, 0, -1.0), (0, 1, 2, 1.0), (0, 2, 1, -1.0), (1, 2, 0, 1.0), (1, 0, 2, -1.0)]


def cube(cells: int = 32, side: float = 2.0, rotation: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Surface:
    """Cube about the origin with `cells` x `cells` squares a side, each two triangles; 6 cells^2 + 2 vertices.

    Parameters
    ----------
    cells : int
    side : float
    rotation : (3,)
        Angles in degrees about x, then y, then z: no method should care.

    Returns
    -------
    Surface
        With the scalar map "side": the number 0..5 of the face's side with the largest coordinate (ties to the first).

    Raises
    ------
    ValueError
        If there is no cell or the side is not positive.
    """
    if cells < 1 or side <= 0:
        raise ValueError(f"cube has cells = {cells}, side = {side}; cells >= 1 and side > 0 are needed")
    line = np.linspace(-1.0, 1.0, cells + 1)
    u, v = (axis.ravel() for axis in np.meshgrid(line, line, indexing="ij"))
    corners = []
    for normal, first, second, sign in SIDES:
        points = np.empty((len(u), 3))
        points[:, normal], points[:, first], points[:, second] = sign, u, v
        corners.append(points[grid_faces(cells + 1, cells + 1)])
    vertices, faces = weld(np.concatenate(corners))
    mesh = TriangleMesh(0.5 * side * vertices @ rotation_matrix(rotation).T, faces)
    sides = np.argmax(np.concatenate([vertices, -vertices], axis=1), axis=1).astype(float)
    return with_metrics(Surface(mesh, name="cube", scalars={"side": sides}))


def rotation_matrix(degrees: tuple[float, float, float]) -> np.ndarray:
    """(3, 3) rotation about x, then y, then z."""
    product = np.eye(3)
    for axis, angle in enumerate(np.radians(degrees)):
        first, second = (axis + 1) % 3, (axis + 2) % 3
        turn = np.eye(3)
        turn[first, first] = turn[second, second] = np.cos(angle)
        turn[second, first], turn[first, second] = np.sin(angle), -np.sin(angle)
        product = turn @ product
    return product
