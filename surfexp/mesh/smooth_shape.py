"""The smooth surfaces of which meshes are exact samples: where the nodes of their elements lie, and what is known of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from surfexp.arrays import Floats
from surfexp.mesh.exact_spectra import disk_spectrum, lattice_spectrum, rectangle_spectrum, sphere_spectrum
from surfexp.mesh.flat_domain import boundary_angles, is_flat
from surfexp.mesh.triangle_mesh import TriangleMesh

TOLERANCE = 1e-9
Vector = tuple[float, float, float]
UP: Vector = (0.0, 0.0, 1.0)


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
        """Return the points of the smooth boundary nearest to points near it.

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


@dataclass(frozen=True)
class Sphere(SmoothShape):
    """A sphere about the origin."""

    radius: float = 1.0

    def project(self, points: Floats) -> Floats:
        """Return the points along their rays."""
        return points * (self.radius / np.linalg.norm(points, axis=1, keepdims=True))

    def spectrum(self, count: int, boundary: str = "neumann") -> Floats:
        """Return l (l + 1) / R^2."""
        return sphere_spectrum(count, self.radius)

    def similar(self, scale: float, rotation: Floats) -> Sphere:
        """A sphere stays one."""
        return Sphere(scale * self.radius)


@dataclass(frozen=True)
class SphericalCap(SmoothShape):
    """The part of a sphere about the origin within `angle` radians of an axis."""

    radius: float
    angle: float
    axis: Vector = UP
    bounded: ClassVar[bool] = True

    def project(self, points: Floats) -> Floats:
        """Return the points along their rays."""
        return Sphere(self.radius).project(points)

    def project_boundary(self, points: Floats) -> Floats:
        """Return the points of the boundary circle at the same longitude."""
        axis = np.array(self.axis)
        aside = points - np.outer(points @ axis, axis)
        aside /= np.linalg.norm(aside, axis=1, keepdims=True)
        return self.radius * (np.cos(self.angle) * axis + np.sin(self.angle) * aside)

    def similar(self, scale: float, rotation: Floats) -> SphericalCap:
        """The axis turns."""
        return SphericalCap(scale * self.radius, self.angle, turned(self.axis, rotation))


@dataclass(frozen=True)
class Torus(SmoothShape):
    """A torus of revolution about an axis through the origin."""

    major_radius: float
    minor_radius: float
    axis: Vector = UP

    def project(self, points: Floats) -> Floats:
        """Return the points nearest on the tube about the centre line."""
        axis = np.array(self.axis)
        circle = points - np.outer(points @ axis, axis)
        circle *= self.major_radius / np.linalg.norm(circle, axis=1, keepdims=True)
        offset = points - circle
        return circle + offset * (self.minor_radius / np.linalg.norm(offset, axis=1, keepdims=True))

    def similar(self, scale: float, rotation: Floats) -> Torus:
        """The axis turns."""
        return Torus(scale * self.major_radius, scale * self.minor_radius, turned(self.axis, rotation))


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


def turned(axis: Vector, rotation: Floats) -> Vector:
    """Return an axis turned by a (3, 3) rotation."""
    x, y, z = (rotation @ np.array(axis)).tolist()
    return x, y, z
