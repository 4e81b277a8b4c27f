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
    inverse = 1.0 / reach
    for row in range(height):
        first, last = _covered(depth[row])
        here, count = depth[row, first:last], last - first
        nx, ny, nz = (
            normals[row, first:last, 0].copy(),
            normals[row, first:last, 1].copy(),
            normals[row, first:last, 2].copy(),
        )
        highest, total = np.zeros(count), np.zeros(count)
        for direction in range(shifts.shape[0]):
            highest.fill(0.0)
            for step in range(shifts.shape[1]):
                dx, dy = float(shifts[direction, step, 0]), float(shifts[direction, step, 1])
                start = rim + first + shifts[direction, step, 0]
                there = around[rim + row + shifts[direction, step, 1], start : start + count]
                flat = dx * dx + dy * dy
                for column in range(count):
                    dz = here[column] - there[column]
                    squared = flat + dz * dz
                    above = nx[column] * dx - ny[column] * dy + nz[column] * dz
                    hidden = (above / np.sqrt(squared) - BIAS) * (1.0 - squared * inverse)
                    hidden = hidden if squared < reach and above > 0.0 else 0.0
                    highest[column] = hidden if hidden > highest[column] else highest[column]
            for column in range(count):
                total[column] += highest[column]
        for column in range(count):
            if here[column] != FAR:
                result[row, first + column] = total[column] / shifts.shape[0]
    return result


@njit(cache=True, nogil=True)
def _covered(depth: Floats) -> tuple[int, int]:
    """The first column of a row in which something is seen, and the one after the last."""
    first, last = 0, len(depth)
    while first < last and depth[first] == FAR:
        first += 1
    while last > first and depth[last - 1] == FAR:
        last -= 1
    return first, last
