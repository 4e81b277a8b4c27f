"""Flat tori as surfaces: drawn in space, with the elements of their triangles in the plane."""

from __future__ import annotations

from typing import Literal

import numpy as np

from surfexp.mesh.rectangle import flat_torus
from surfexp.mesh.surface import Surface
from surfexp.mesh.torus import torus
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.intrinsic_delaunay import hat_gradients_from_lengths
from surfexp.operators.surface_operator import SurfaceOperator

Lattice = Literal["square", "hexagonal"]
NAMES = {"square": "square flat torus", "hexagonal": "hexagonal flat torus"}


def periodic_surface(n: int = 40, lattice: Lattice = "square") -> Surface:
    """Return a grid on the plane modulo a lattice with unit periods.

    Parameters
    ----------
    n : int
        Vertices along each period, at least 3.
    lattice : "square" or "hexagonal"
        See `flat_torus`; on the hexagonal one all triangles are equilateral.

    Returns
    -------
    Surface
        The mesh is drawn as a torus of revolution, whose lengths mean nothing; the metric `area` is that of the plane.

    Raises
    ------
    ValueError
        If n is under 3 or the lattice is unknown.
    """
    if lattice not in NAMES:
        raise ValueError(f"lattice {lattice!r} is unknown, choose square or hexagonal")
    faces, corners = flat_torus(n, lattice == "hexagonal")
    sides = corners[:, 1:] - corners[:, :1]
    area = 0.5 * float(np.abs(np.linalg.det(sides)).sum())
    metrics = {"vertices": float(n * n), "faces": float(len(faces)), "genus": 1.0, "area": area}
    notes = ("The torus is flat and only drawn in space: take operator=periodic.",)
    return Surface(TriangleMesh(torus(n, n).mesh.vertices, faces), NAMES[lattice], metrics=metrics, notes=notes)


def periodic_operator(surface: Surface) -> SurfaceOperator:
    """Return linear elements on the triangles of a flat torus as they lie in the plane.

    Raises
    ------
    ValueError
        If the surface is no flat torus.
    """
    if surface.name not in NAMES.values():
        raise ValueError(f"the surface {surface.name!r} has no periods: operator periodic takes a flat_torus")
    count = len(surface.mesh.vertices)
    faces, corners = flat_torus(round(count**0.5), surface.name == NAMES["hexagonal"])
    lengths = np.linalg.norm(corners[:, [1, 2, 0]] - corners, axis=2)
    return SurfaceOperator(faces, *hat_gradients_from_lengths(lengths), count, name="periodic")
