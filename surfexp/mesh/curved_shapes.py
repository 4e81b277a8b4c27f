"""Smooth shapes that curve in space, on which curved elements put their nodes: sphere, spherical cap, torus."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.exact_spectra import sphere_spectrum
from surfexp.mesh.smooth_shape import SmoothShape

Vector = tuple[float, float, float]
UP: Vector = (0.0, 0.0, 1.0)


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


def turned(axis: Vector, rotation: Floats) -> Vector:
    """Return an axis turned by a (3, 3) rotation."""
    x, y, z = (rotation @ np.array(axis)).tolist()
    return x, y, z
