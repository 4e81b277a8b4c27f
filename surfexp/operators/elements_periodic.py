"""Flat tori as surfaces: drawn in space, with the elements of their triangles in the plane."""

from __future__ import annotations

from typing import Literal

import numpy as np

from surfexp.mesh.flat_shapes import FlatTorus
from surfexp.mesh.shapes.rectangle import flat_torus
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.intrinsic_delaunay import hat_gradients_from_lengths
from surfexp.operators.surface_operator import SurfaceOperator

Lattice = Literal["square", "hexagonal"]
SHAPES = {"square": FlatTorus(), "hexagonal": FlatTorus((1.0, 0.0), (-0.5, 0.75**0.5))}


def periodic_surface(n: int = 40, lattice: Lattice = "square") -> Surface:
    """Return a grid on the plane modulo a lattice with unit periods, for the operator `periodic`.

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
    if lattice not in SHAPES:
        raise ValueError(f"lattice {lattice!r} is unknown, choose square or hexagonal")
    faces, _ = flat_torus(n, lattice == "hexagonal")
    metrics = {"vertices": float(n * n), "faces": float(len(faces)), "genus": 1.0, "area": SHAPES[lattice].area}
    notes = ("The torus is flat and only drawn in space: take operator=periodic.",)
    mesh = TriangleMesh(torus(n, n).mesh.vertices, faces)
    return Surface(mesh, f"{lattice} flat torus", metrics=metrics, notes=notes, shape=SHAPES[lattice])


def periodic_operator(surface: Surface) -> SurfaceOperator:
    """Return linear elements on the triangles of a flat torus as they lie in the plane.

    Raises
    ------
    ValueError
        If the surface is no flat torus, or its vertices are in another order than its maker's.
    """
    if not isinstance(surface.shape, FlatTorus):
        raise ValueError(f"the surface {surface.name!r} has no periods: operator periodic takes a flat_torus")
    count = len(surface.mesh.vertices)
    faces, corners = flat_torus(round(count**0.5), surface.shape == SHAPES["hexagonal"])
    if surface.shape not in SHAPES.values() or not np.array_equal(faces, surface.mesh.faces):
        raise ValueError(
            f"the faces of {surface.name!r} are not those of periodic_surface: take a flat_torus as it is made"
        )
    lengths = np.linalg.norm(corners[:, [1, 2, 0]] - corners, axis=2)
    return SurfaceOperator(faces, *hat_gradients_from_lengths(lengths), count, name="periodic")
