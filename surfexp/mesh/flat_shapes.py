"""Smooth shapes without curvature, whose corners or spectra are known: disk, polygon, rectangle, flat torus."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.curved_shapes import Sphere
from surfexp.mesh.exact_spectra import disk_spectrum, lattice_spectrum, rectangle_spectrum
from surfexp.mesh.flat_domain import boundary_angles, is_flat
from surfexp.mesh.smooth_shape import TOLERANCE, SmoothShape
from surfexp.mesh.triangle_mesh import TriangleMesh


@dataclass(frozen=True)
class Disk(SmoothShape):
    """A flat disk about the origin."""

    radius: float = 1.0
    bounded: ClassVar[bool] = True

    def project(self, points: Floats) -> Floats:
        """Points of the plane stay."""
        return points

    def project_boundary(self, points: Floats) -> Floats:
        """Return the points of the circle along their rays."""
        return Sphere(self.radius).project(points)

    def spectrum(self, count: int, boundary: str = "neumann") -> Floats:
        """Return squared zeros of Bessel functions or their derivatives."""
        return disk_spectrum(count, self.radius, boundary)

    def similar(self, scale: float, rotation: Floats) -> Disk:
        """A disk stays one."""
        return Disk(scale * self.radius)

    def holds(self, mesh: TriangleMesh) -> bool:
        """Whether the mesh is flat and its boundary on the circle."""
        return is_flat(mesh) and super().holds(mesh)


@dataclass(frozen=True)
class Polygon(SmoothShape):
    """A flat domain with straight sides, known by its inner angles in radians and its area."""

    angles: tuple[float, ...]
    area: float

    @property
    def corners(self) -> tuple[float, ...]:
        """The inner angles."""
        return self.angles

    def similar(self, scale: float, rotation: Floats) -> Polygon:
        """Angles stay."""
        return Polygon(self.angles, scale**2 * self.area)

    def holds(self, mesh: TriangleMesh) -> bool:
        """Whether the mesh is flat and has the angles and the area."""
        angles = boundary_angles(mesh) if is_flat(mesh) and mesh.boundary_loops else np.zeros(0)
        alike = len(angles) == len(self.angles) and np.allclose(
            np.sort(angles), np.sort(self.angles), rtol=0, atol=1e-6
        )
        return bool(alike and abs(mesh.area / self.area - 1.0) <= TOLERANCE)


@dataclass(frozen=True)
class Rectangle(SmoothShape):
    """A flat rectangle."""

    width: float
    height: float

    @property
    def corners(self) -> tuple[float, ...]:
        """Four right angles."""
        return (0.5 * np.pi,) * 4

    def spectrum(self, count: int, boundary: str = "neumann") -> Floats:
        """Return pi^2 (m^2 / a^2 + n^2 / b^2)."""
        return rectangle_spectrum(count, self.width, self.height, boundary)

    def similar(self, scale: float, rotation: Floats) -> Rectangle:
        """Its sides grow."""
        return Rectangle(scale * self.width, scale * self.height)

    def holds(self, mesh: TriangleMesh) -> bool:
        """Whether the mesh is flat with four right angles, that area, and that diagonal."""
        if not Polygon(self.corners, self.width * self.height).holds(mesh):
            return False
        centred = mesh.vertices - mesh.vertices.min(axis=0) / 2.0 - mesh.vertices.max(axis=0) / 2.0
        corners = np.sort(np.linalg.norm(centred - centred[np.argmax((centred**2).sum(axis=1))], axis=1))
        return bool(abs(corners[-1] / np.hypot(self.width, self.height) - 1.0) <= TOLERANCE)


@dataclass(frozen=True)
class FlatTorus(SmoothShape):
    """The plane modulo the periods a and b; its mesh in space is a drawing, whose lengths mean nothing."""

    a: tuple[float, float] = (1.0, 0.0)
    b: tuple[float, float] = (0.0, 1.0)

    @property
    def area(self) -> float:
        """Area of a cell of the lattice."""
        return abs(self.a[0] * self.b[1] - self.a[1] * self.b[0])

    def spectrum(self, count: int, boundary: str = "neumann") -> Floats:
        """Return 4 pi^2 |w|^2 over the dual lattice."""
        return lattice_spectrum(count, np.array([self.a, self.b]))

    def similar(self, scale: float, rotation: Floats) -> FlatTorus:
        """A drawing of another size shows the same torus."""
        return self

    def holds(self, mesh: TriangleMesh) -> bool:
        """Whether the mesh is a torus."""
        return mesh.is_closed and mesh.component_count == 1 and mesh.euler_characteristic == 0
