"""Horizon-based ambient occlusion from a depth picture (Bavoil, Sainz and Dimitrov 2008)."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.mesh.triangle_mesh import Floats

DIRECTIONS = 16
STEPS = 7
# sines under this are the facets of the mesh, not its folds
BIAS = 0.08


def ambient_occlusion(depth: Floats, normals: Floats, radius: float) -> Floats:
    """(height, width) share of the sky that nearby surface hides, 0 in the open.

    Along each of 16 directions on the screen the steepest elevation above the tangent plane is kept, faded out with
    the distance; the mean over the directions is returned.

    Parameters
    ----------
    depth : (height, width) float64
        Behind the screen, in pixels; infinite where there is nothing.
    normals : (height, width, 3) float64
        Unit normals in camera coordinates.
    radius : float
        Reach in pixels.
    """
    angles = 2.0 * np.pi * (np.arange(DIRECTIONS) + 0.5) / DIRECTIONS
    reach = np.maximum(radius * (np.arange(1, STEPS + 1) / STEPS) ** 1.7, 1.0)
    shifts = np.rint(reach[None, :, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)[:, None, :])
    return _occlusion(depth, normals, shifts.astype(np.int64), radius)


@njit(cache=True, nogil=True)
def _occlusion(depth, normals, shifts, radius):  # type: ignore[no-untyped-def]
    height, width = depth.shape
    result = np.zeros((height, width))
    for row in range(height):
        for column in range(width):
            if not np.isfinite(depth[row, column]):
                continue
            nx, ny, nz = normals[row, column]
            total = 0.0
            for direction in range(shifts.shape[0]):
                highest = 0.0
                for step in range(shifts.shape[1]):
                    dx, dy = shifts[direction, step, 0], shifts[direction, step, 1]
                    i, j = row + dy, column + dx
                    if i < 0 or j < 0 or i >= height or j >= width or not np.isfinite(depth[i, j]):
                        continue
                    dz = depth[row, column] - depth[i, j]
                    squared = dx * dx + dy * dy + dz * dz
                    if squared >= radius * radius or squared == 0.0:
                        continue
                    sine = (nx * dx - ny * dy + nz * dz) / np.sqrt(squared) - BIAS
                    highest = max(highest, sine * (1.0 - squared / (radius * radius)))
                total += highest
            result[row, column] = total / shifts.shape[0]
    return result
