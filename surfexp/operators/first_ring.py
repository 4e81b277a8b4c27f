"""The published gradient and divergence by their definitions (1.17), (1.18), afresh from the positions at each call."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats, Integers


@njit(cache=True, nogil=True)
def ring_gradient(vertices: Floats, faces: Integers, values: Floats) -> Floats:
    """Return the area-weighted mean of the face gradients around each vertex, (n, 3); equal to W f of (1.27).

    Parameters
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int64
    values : (n,) float64
    """
    result, rings = np.zeros_like(vertices), np.zeros(len(vertices))
    hats = np.empty((3, 3))
    for f in range(len(faces)):
        area = _hats_times_area(vertices, faces, f, hats)
        for x in range(3):
            slope = 0.0
            for k in range(3):
                slope += values[faces[f, k]] * hats[k, x]
            for k in range(3):
                result[faces[f, k], x] += slope
        for k in range(3):
            rings[faces[f, k]] += area
    for i in range(len(vertices)):
        for x in range(3):
            result[i, x] /= rings[i]
    return result


@njit(cache=True, nogil=True)
def ring_divergence(vertices: Floats, faces: Integers, field: Floats) -> Floats:
    """Return the area-weighted mean of the face divergences around each vertex, (n,); equal to W . V of (1.27).

    Parameters
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int64
    field : (n, 3) float64
    """
    result, rings = np.zeros(len(vertices)), np.zeros(len(vertices))
    hats = np.empty((3, 3))
    for f in range(len(faces)):
        area = _hats_times_area(vertices, faces, f, hats)
        source = 0.0
        for k in range(3):
            for x in range(3):
                source += field[faces[f, k], x] * hats[k, x]
        for k in range(3):
            result[faces[f, k]] += source
            rings[faces[f, k]] += area
    for i in range(len(vertices)):
        result[i] /= rings[i]
    return result


@njit(cache=True, nogil=True)
def _hats_times_area(vertices: Floats, faces: Integers, f: int, hats: Floats) -> float:
    """Write the area times the gradients of the three hat functions of a face to `hats`; return the area."""
    a, b, c = vertices[faces[f, 0]], vertices[faces[f, 1]], vertices[faces[f, 2]]
    ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    vx, vy, vz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    uu, uv, vv = ux * ux + uy * uy + uz * uz, ux * vx + uy * vy + uz * vz, vx * vx + vy * vy + vz * vz
    area = 0.5 * np.sqrt(uu * vv - uv * uv)
    scale = 0.25 / area
    hats[1, 0], hats[1, 1], hats[1, 2] = (
        scale * (vv * ux - uv * vx),
        scale * (vv * uy - uv * vy),
        scale * (vv * uz - uv * vz),
    )
    hats[2, 0], hats[2, 1], hats[2, 2] = (
        scale * (uu * vx - uv * ux),
        scale * (uu * vy - uv * uy),
        scale * (uu * vz - uv * uz),
    )
    for x in range(3):
        hats[0, x] = -hats[1, x] - hats[2, x]
    return area
