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
    whole = shifts.astype(np.int64)
    # a rim of nothing, so that no step leaves the picture; the columns of a row are then taken several at once
    rim = int(np.abs(whole).max())
    return _occlusion(far, np.pad(far, rim, constant_values=FAR), rim, normals, whole, radius)


@njit(cache=True, nogil=True, error_model="numpy")
def _occlusion(depth: Floats, around: Floats, rim: int, normals: Floats, shifts: Integers, radius: float) -> Floats:
    height, width = depth.shape
    result = np.zeros((height, width))
    reach = radius * radius
    highest, total = np.zeros(width), np.zeros(width)
    for row in range(height):
        here = depth[row]
        if here.min() == FAR:
            continue
        nx, ny, nz = normals[row, :, 0].copy(), normals[row, :, 1].copy(), normals[row, :, 2].copy()
        total.fill(0.0)
        for direction in range(shifts.shape[0]):
            highest.fill(0.0)
            for step in range(shifts.shape[1]):
                dx, dy = float(shifts[direction, step, 0]), float(shifts[direction, step, 1])
                start = rim + shifts[direction, step, 0]
                there = around[rim + row + shifts[direction, step, 1], start : start + width]
                flat = dx * dx + dy * dy
                for column in range(width):
                    dz = here[column] - there[column]
                    squared = flat + dz * dz
                    above = nx[column] * dx - ny[column] * dy + nz[column] * dz
                    hidden = (above / np.sqrt(squared) - BIAS) * (1.0 - squared / reach)
                    hidden = hidden if squared < reach and above > 0.0 else 0.0
                    highest[column] = hidden if hidden > highest[column] else highest[column]
            for column in range(width):
                total[column] += highest[column]
        for column in range(width):
            if here[column] != FAR:
                result[row, column] = total[column] / shifts.shape[0]
    return result
