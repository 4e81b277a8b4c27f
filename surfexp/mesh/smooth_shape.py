"""What is known of the smooth surface of which a mesh is an exact sample: nearest points, corners, spectrum."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.triangle_mesh import TriangleMesh

TOLERANCE = 1e-9


@dataclass(frozen=True)
class SmoothShape:
    """A smooth surface in space about the origin, of which the vertices of a mesh are exact points."""

    bounded: ClassVar[bool] = False

    @property
    def words(self) -> str:
        """What the shape is, for messages."""
        sizes = ", ".join(f"{name} {value}" for name, value in vars(self).items())
        return f"{type(self).__name__} ({sizes})"

    @property
    def corners(self) -> tuple[float, ...] | None:
        """Inner angles of a flat domain with straight sides, radians; None for a smooth boundary or none."""
        return None

    def project(self, points: Floats) -> Floats:
        """Return the points of the smooth surface nearest to points.

        Parameters
        ----------
        points : (n, 3) float64

        Returns
        -------
        (n, 3) float64

        Raises
        ------
        ValueError
            If the shape has no curved elements.
        """
        raise ValueError(f"{self.words} has no curved elements: choose curved=false")

    def project_boundary(self, points: Floats) -> Floats:
        """Return the points of the smooth boundary nearest to points near it; errors are those of `project`.

        Parameters
        ----------
        points : (n, 3) float64

        Returns
        -------
        (n, 3) float64
        """
        return self.project(points)

    def spectrum(self, count: int, boundary: str = "neumann") -> Floats:
        """Return the first Laplace-Beltrami eigenvalues of the smooth shape.

        Parameters
        ----------
        count : int
        boundary : {"neumann", "dirichlet"}

        Returns
        -------
        (count,) float64
            Increasing, in 1 / length^2.

        Raises
        ------
        ValueError
            If they are not known in closed form.
        """
        raise ValueError(
            f"the spectrum of {self.words} is not known in closed form, choose a sphere, disk, rectangle or flat torus"
        )

    def similar(self, scale: float, rotation: Floats) -> SmoothShape:
        """Return the shape of the scaled points, turned about the origin.

        Parameters
        ----------
        scale : float
        rotation : (3, 3) float64

        Returns
        -------
        SmoothShape
        """
        raise NotImplementedError

    def holds(self, mesh: TriangleMesh) -> bool:
        """Whether the vertices of a mesh lie on the shape, and its boundary on that of the shape.

        Parameters
        ----------
        mesh : TriangleMesh

        Returns
        -------
        bool
            True where they do to 1e-9 of the size.
        """
        vertices = mesh.vertices
        boundary = vertices[np.concatenate(mesh.boundary_loops)] if mesh.boundary_loops else vertices[:0]
        if bool(len(boundary)) != self.bounded:
            return False
        with np.errstate(divide="ignore", invalid="ignore"):
            there = np.concatenate([self.project(vertices), self.project_boundary(boundary)])
        miss = np.abs(there - np.concatenate([vertices, boundary])).max()
        return bool(miss <= TOLERANCE * np.abs(vertices).max())
