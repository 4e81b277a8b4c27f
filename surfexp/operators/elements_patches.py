"""Cubic patches through the vertices of a mesh and across its normals, for nodes of order 2 and 3 on a bare mesh."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.elements_lagrange import lagrange_nodes


def patch_positions(mesh: TriangleMesh, order: int, normals: Floats | None = None) -> Floats:
    """(m, b, 3) nodes on the PN triangles of a mesh (Vlachos, Peters, Boyd and Mitchell 2001).

    Each side becomes the cubic curve whose tangents at its ends are the side's projections on the tangent planes, so that
    faces agree on common sides. Creases are rounded.

    Parameters
    ----------
    mesh : TriangleMesh
    order : 1, 2 or 3
    normals : (n, 3) float64, optional
        Unit normals at the vertices; default: `patch_normals`.
    """
    normals = patch_normals(mesh) if normals is None else normals
    corners, across = mesh.vertices[mesh.faces], normals[mesh.faces]
    start, end = np.array([0, 0, 1, 1, 2, 2]), np.array([1, 2, 2, 0, 0, 1])
    sides = corners[:, end] - corners[:, start]
    out = across[:, start]
    handles = corners[:, start] + (sides - np.einsum("mkd,mkd->mk", sides, out)[..., None] * out) / 3.0
    middle = handles.mean(axis=1)
    middle += 0.5 * (middle - corners.mean(axis=1))
    controls = np.concatenate([corners, handles, middle[:, None]], axis=1)
    return np.asarray(np.einsum("bc,mcd->mbd", _bernstein(lagrange_nodes(order), start, end), controls))


def patch_normals(mesh: TriangleMesh) -> Floats:
    """(n, 3) unit normals with the weights of Max (1999), sin(angle) / (|e| |f|), exact where vertices lie on a sphere.

    Raises
    ------
    ValueError
        If a normal vanishes.
    """
    corners = mesh.vertices[mesh.faces]
    normals = np.zeros_like(mesh.vertices)
    for k in range(3):
        one, two = corners[:, (k + 1) % 3] - corners[:, k], corners[:, (k + 2) % 3] - corners[:, k]
        lengths = np.einsum("md,md->m", one, one) * np.einsum("md,md->m", two, two)
        np.add.at(normals, mesh.faces[:, k], np.cross(one, two) / np.maximum(lengths, 1e-300)[:, None])
    sizes = np.linalg.norm(normals, axis=1)
    if not np.isfinite(sizes).all() or sizes.min() <= 0:
        raise ValueError(f"vertex {int(np.argmin(sizes))} has no normal: repair the mesh")
    return normals / sizes[:, None]


def _bernstein(places: Floats, start: np.ndarray, end: np.ndarray) -> Floats:
    """(b, 10) cubic Bernstein polynomials of corners, side handles and the middle at barycentric places."""
    handles = 3.0 * places[:, start] ** 2 * places[:, end]
    return np.concatenate([places**3, handles, 6.0 * places.prod(axis=1, keepdims=True)], axis=1)
