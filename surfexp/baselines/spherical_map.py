"""Conformal map of a closed genus-0 surface to the unit sphere, by one linear system and stereographic projection."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from surfexp.baselines.moebius import centred
from surfexp.contract.arrays import Floats
from surfexp.linalg.ldlt import ldlt
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.assembly import stiffness
from surfexp.operators.fem import fem


def spherical_map(mesh: TriangleMesh) -> Floats:
    """Map a closed genus-0 surface to the unit sphere, angles kept as far as the mesh lets them.

    Solves Laplace(z) = (d/dx - i d/dy) delta_p with linear elements and the cotangent matrix, the singular point p
    inside the most regular face; stereographic projection takes the plane to the sphere, scaled so that half of the
    area lies on each hemisphere, and a Moebius transformation puts the centre of mass at the origin.

    Parameters
    ----------
    mesh : TriangleMesh

    Returns
    -------
    (n, 3) float64
        Points on the unit sphere, oriented as the mesh.

    Raises
    ------
    ValueError
        If the mesh is not one closed surface of genus 0.

    References
    ----------
    Haker, Angenent, Tannenbaum, Kikinis, Sapiro, Halle: Conformal surface parameterization for texture mapping (2000).
    """
    check_sphere(mesh)
    plane = _plane_map(mesh)
    areas = mesh.vertex_areas
    plane -= _weighted_median(plane.real, areas) + 1j * _weighted_median(plane.imag, areas)
    plane /= _weighted_median(np.abs(plane), areas)
    return centred(inverse_stereographic(plane), areas)


def check_sphere(mesh: TriangleMesh) -> None:
    """Refuse a mesh that is not a topological sphere.

    Raises
    ------
    ValueError
        As `spherical_map`.
    """
    if not mesh.is_closed or mesh.component_count != 1 or mesh.genus != 0:
        raise ValueError(
            f"surface has {len(mesh.boundary_loops)} boundary loops, {mesh.component_count} components and genus "
            f"{mesh.genus}, a spherical map needs 0, 1 and 0; take disk_map for a patch, patchwise for a higher genus"
        )


def inverse_stereographic(plane: np.ndarray) -> Floats:
    """Points (2 x, 2 y, 1 - |z|^2) / (1 + |z|^2) of the unit sphere for complex (n,) z = x + i y.

    The plane is seen from the pole at infinity (0, 0, -1), so that a counter-clockwise triangle stays one seen from
    outside.
    """
    square = np.abs(plane) ** 2
    return np.stack([2.0 * plane.real, 2.0 * plane.imag, 1.0 - square], axis=1) / (1.0 + square)[:, None]


def _plane_map(mesh: TriangleMesh) -> np.ndarray:
    corners = mesh.faces[_most_regular_face(mesh)]
    a, b, c = mesh.vertices[corners]
    side = b - a
    theta = float((c - a) @ side / (side @ side))
    length, height = np.linalg.norm(side), np.linalg.norm(c - a - theta * side)
    source = np.zeros(len(mesh.vertices), dtype=np.complex128)
    source[corners] = [-1 / length + 1j * (1 - theta) / height, 1 / length + 1j * theta / height, -1j / height]
    matrix = csr_array(stiffness(fem(mesh)))
    free = np.arange(1, len(source))
    solution = ldlt(matrix[free][:, free]).solve(np.stack([source.real[1:], source.imag[1:]], axis=1))
    plane = np.zeros_like(source)
    plane[1:] = solution[:, 0] + 1j * solution[:, 1]
    x, y, z = plane[mesh.faces.T]
    twice_area = ((y - x).conj() * (z - x)).imag
    keep = np.ones(len(mesh.faces), dtype=bool)
    keep[_most_regular_face(mesh)] = False
    return plane if twice_area[keep].sum() > 0 else plane.conj()


def _most_regular_face(mesh: TriangleMesh) -> int:
    corners = mesh.vertices[mesh.faces]
    squares = ((corners - np.roll(corners, 1, axis=1)) ** 2).sum(axis=(1, 2))
    return int(np.argmax(mesh.areas / squares))


def _weighted_median(values: Floats, weights: Floats) -> float:
    order = np.argsort(values, kind="stable")
    cumulated = np.cumsum(weights[order])
    return float(values[order[np.searchsorted(cumulated, 0.5 * cumulated[-1])]])
