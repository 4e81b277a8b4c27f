"""Surfaces whose smooth shape is known: where the new nodes of their elements lie, and their exact spectra."""

from __future__ import annotations

import numpy as np
from scipy.special import jn_zeros, jnp_zeros

from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import Floats
from surfexp.operators.elements_surface import Projection

ROUND = ("sphere", "disk", "torus")


def projections(surface: Surface) -> tuple[Projection | None, Projection | None]:
    """Return the maps onto the smooth surface and onto its smooth rim; None where points stay as they are.

    Raises
    ------
    ValueError
        If the smooth shape of the surface is unknown, or it is flat with straight sides.
    """
    vertices = surface.mesh.vertices
    if surface.name == "sphere":
        radius = float(np.linalg.norm(vertices, axis=1).mean())
        return lambda points: points * (radius / np.linalg.norm(points, axis=1, keepdims=True)), None
    if surface.name == "disk":
        radius = float(np.linalg.norm(vertices, axis=1).max())
        return None, lambda points: points * (radius / np.linalg.norm(points, axis=1, keepdims=True))
    if surface.name == "torus":
        distance = np.linalg.norm(vertices[:, :2], axis=1)
        # both radii follow from any two vertices, the highest one lies above the centre line
        major = float(distance[np.argmax(vertices[:, 2])])
        minor = float(np.hypot(distance - major, vertices[:, 2]).mean())
        return lambda points: _onto_torus(points, major, minor), None
    raise ValueError(
        f"the smooth shape of {surface.name!r} is unknown, choose curved=false or one of {', '.join(ROUND)}"
    )


def _onto_torus(points: Floats, major: float, minor: float) -> Floats:
    circle = points * [1.0, 1.0, 0.0]
    circle *= major / np.linalg.norm(circle, axis=1, keepdims=True)
    offset = points - circle
    return circle + offset * (minor / np.linalg.norm(offset, axis=1, keepdims=True))


def sphere_spectrum(count: int, radius: float = 1.0) -> Floats:
    """Return the first eigenvalues l (l + 1) / R^2, 2 l + 1 times each."""
    degree = np.arange(int(np.sqrt(count)) + 2)
    return np.repeat(degree * (degree + 1.0), 2 * degree + 1)[:count] / radius**2


def rectangle_spectrum(count: int, width: float, height: float, boundary: str) -> Floats:
    """Return the first eigenvalues pi^2 (m^2 / a^2 + n^2 / b^2), from 0 (Neumann) or 1 (Dirichlet) on."""
    m = np.arange(0 if boundary == "neumann" else 1, count + 1)
    return np.sort((np.pi**2 * ((m[:, None] / width) ** 2 + (m[None, :] / height) ** 2)).ravel())[:count]


def flat_torus_spectrum(count: int, equilateral: bool = False) -> Floats:
    """Return the first eigenvalues 4 pi^2 |w|^2 over the dual lattice of the torus with unit periods."""
    reach = np.arange(-count, count + 1)
    reach = reach[np.abs(reach) <= 2 * int(np.sqrt(count)) + 2]
    m, n = np.meshgrid(reach, reach, indexing="ij")
    # dual to (1, 0), (-1/2, sqrt(3)/2)
    squares = 4.0 / 3.0 * (m**2 + m * n + n**2) if equilateral else 1.0 * m**2 + n**2
    return np.sort(4.0 * np.pi**2 * squares.ravel())[:count]


def disk_spectrum(count: int, radius: float, boundary: str) -> Floats:
    """Return the first squared zeros of the Bessel functions (Dirichlet) or their derivatives (Neumann)."""
    zeros = jn_zeros if boundary == "dirichlet" else jnp_zeros
    reach = int(2.5 * np.sqrt(count)) + 4
    found = [np.repeat(zeros(order, reach) ** 2, 1 if order == 0 else 2) for order in range(reach)]
    found += [np.zeros(1)] if boundary == "neumann" else []
    return np.sort(np.concatenate(found))[:count] / radius**2


def exact_spectrum(surface: Surface, count: int, boundary: str = "neumann") -> Floats:
    """Return the first eigenvalues of the smooth surface that a mesh stands for.

    Raises
    ------
    ValueError
        If they are not known in closed form.
    """
    vertices = surface.mesh.vertices
    radius = float(np.linalg.norm(vertices, axis=1).max())
    if surface.name == "sphere":
        return sphere_spectrum(count, radius)
    if surface.name == "disk":
        return disk_spectrum(count, radius, boundary)
    if surface.name == "rectangle":
        width, height = np.ptp(vertices, axis=0)[:2]
        return rectangle_spectrum(count, float(width), float(height), boundary)
    if surface.name.endswith("flat torus"):
        return flat_torus_spectrum(count, surface.name.startswith("hexagonal"))
    raise ValueError(
        f"the spectrum of {surface.name!r} is not known in closed form, choose sphere, disk, rectangle or flat torus"
    )
