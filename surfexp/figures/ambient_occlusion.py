"""Horizon-based ambient occlusion from a depth picture (Bavoil, Sainz and Dimitrov 2008)."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats, Integers

DIRECTIONS = 12
STEPS = 7
# sines under this are the facets of the mesh, not its folds
BIAS = 0.08
FAR = 1e30


def ambient_occlusion(depth: Floats, normals: Floats, radius: float, nearest: float = 1.0) -> Floats:
    """(height, width) share of the sky that nearby surface hides, 0 in the open.

    Along each of 12 directions on the screen the steepest elevation above the tangent plane is kept, faded out with
    the distance; the mean over the directions is returned.

    Parameters
    ----------
    depth : (height, width) float64
        Behind the screen, in pixels; infinite where there is nothing.
    normals : (height, width, 3) float64
        Unit normals in camera coordinates.
    radius : float
        Reach in pixels.
    nearest : float
        Distance in pixels within which nothing hides the sky. The length of an edge keeps facets out of the picture.
    """
    angles = 2.0 * np.pi * (np.arange(DIRECTIONS) + 0.5) / DIRECTIONS
    first = min(max(nearest, 1.0), 0.5 * radius)
    reach = first + (radius - first) * (np.arange(STEPS) / STEPS) ** 1.5
    shifts = np.rint(reach[None, :, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)[:, None, :])
    # nothing is far behind everything, where it hides no sky
    far = np.where(np.isfinite(depth), depth, FAR)
    return _occlusion(far, normals, shifts.astype(np.int64), radius)


@njit(cache=True, nogil=True)
def _occlusion(depth: Floats, normals: Floats, shifts: Integers, radius: float) -> Floats:
    height, width = depth.shape
    result = np.zeros((height, width))
    reach = radius * radius
    for row in range(height):
        for column in range(width):
            here = depth[row, column]
            if here == FAR:
                continue
            nx, ny, nz = normals[row, column]
            total = 0.0
            for direction in range(shifts.shape[0]):
                highest = 0.0
                for step in range(shifts.shape[1]):
                    dx, dy = shifts[direction, step, 0], shifts[direction, step, 1]
                    i, j = row + dy, column + dx
                    if i < 0 or j < 0 or i >= height or j >= width:
                        break
                    dz = here - depth[i, j]
                    squared = dx * dx + dy * dy + dz * dz
                    above = nx * dx - ny * dy + nz * dz
                    if squared < reach and above > 0.0:
                        highest = max(highest, (above / np.sqrt(squared) - BIAS) * (1.0 - squared / reach))
                total += highest
            result[row, column] = total / shifts.shape[0]
    return result
