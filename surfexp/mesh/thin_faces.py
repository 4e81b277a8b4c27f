"""Faces without area and faces with a small angle."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.vertex_star import Vector, cross, difference, dot

ZERO_AREA = 1e-9


def zero_area_faces(mesh: TriangleMesh) -> NDArray[np.bool_]:
    """(m,) faces whose area is at most 1e-9 of the square of their longest side."""
    return np.asarray(_zero_area(mesh.vertices, mesh.faces, ZERO_AREA))


def sharp_faces(mesh: TriangleMesh, degrees: float) -> NDArray[np.bool_]:
    """(m,) faces with an angle whose sine is below that of `degrees`."""
    return np.asarray(_sharp(mesh.vertices, mesh.faces, np.sin(np.radians(degrees))))


@njit(cache=True, nogil=True)
def _zero_area(vertices: Floats, faces: Integers, bound: float) -> NDArray[np.bool_]:
    found = np.zeros(len(faces), np.bool_)
    for f in range(len(faces)):
        u, v, w = _sides(vertices, faces, f)
        found[f] = 0.5 * _length(cross(w, u)) <= bound * max(dot(u, u), dot(v, v), dot(w, w))
    return found


@njit(cache=True, nogil=True)
def _sharp(vertices: Floats, faces: Integers, sine: float) -> NDArray[np.bool_]:
    found = np.zeros(len(faces), np.bool_)
    for f in range(len(faces)):
        u, v, w = _sides(vertices, faces, f)
        found[f] = min(_sine(u, w), _sine(v, u), _sine(w, v)) < sine
    return found


@njit(cache=True, nogil=True)
def _sides(vertices: Floats, faces: Integers, f: int) -> tuple[Vector, Vector, Vector]:
    a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
    return difference(vertices, a, b), difference(vertices, b, c), difference(vertices, c, a)


@njit(cache=True, nogil=True)
def _sine(u: Vector, v: Vector) -> float:
    return _length(cross(u, v)) / max(_length(u) * _length(v), 1e-300)


@njit(cache=True, nogil=True)
def _length(u: Vector) -> float:
    return np.sqrt(dot(u, u))
