"""A flat patch from a mask: staircase boundary as in manual labels, nearly equilateral triangles inside."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.triangle_mesh import TriangleMesh

Mask = Any


def triangulate_region(
    inside: Callable[[Floats], Mask], lower: Floats, upper: Floats, pixel: float, edge_length: float
) -> TriangleMesh:
    """Triangulate the pixels whose centres lie in a region of the plane.

    Parameters
    ----------
    inside : callable
        (n, 2) points to (n,) bool.
    lower, upper : (2,) float64
        Corners of a box that holds the region.
    pixel, edge_length : float
        Side of the pixels, and of the triangles; edges on the boundary are pixel sides or halves of them.

    Returns
    -------
    TriangleMesh
        In the plane z = 0, facing +z, simply connected.

    Raises
    ------
    ValueError
        If no pixel lies inside.
    """
    counts = np.ceil((upper - lower) / pixel).astype(int) + 2
    axes = [lower[k] + pixel * (np.arange(counts[k]) - 0.5) for k in range(2)]
    centres = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    mask = clean_mask(np.asarray(inside(centres.reshape(-1, 2)), dtype=bool).reshape(counts))
    if not mask.any():
        raise ValueError(f"no pixel of side {pixel:g} lies in the region: take smaller ones")
    origin = lower - pixel
    return triangulate_mask(mask, pixel, origin, edge_length)


def clean_mask(mask: Mask) -> Mask:
    """The largest piece of a mask without holes, and without pixels that touch at a corner only."""
    from scipy.ndimage import binary_fill_holes, label

    mask = np.pad(mask, 1)
    while True:
        pieces, count = label(mask)
        if count > 1:
            mask = pieces == 1 + np.argmax(np.bincount(pieces.ravel())[1:])
        mask = binary_fill_holes(mask)
        a, b, c, d = mask[:-1, :-1], mask[1:, :-1], mask[:-1, 1:], mask[1:, 1:]
        falling, rising = a & d & ~b & ~c, b & c & ~a & ~d
        if not (falling.any() or rising.any()):
            return mask[1:-1, 1:-1]
        mask[1:, :-1] |= falling
        mask[:-1, :-1] |= rising


def triangulate_mask(mask: Mask, pixel: float, origin: Floats, edge_length: float) -> TriangleMesh:
    """Delaunay triangles of the boundary's points and a lattice inside; those whose centre lies in the mask are kept.

    Boundary points stand so close, and lattice points so far from the boundary, that every boundary edge is in the
    triangulation.
    """
    from scipy.ndimage import distance_transform_edt
    from scipy.spatial import Delaunay

    padded = np.pad(mask, 1)
    corner = origin - pixel
    parts = max(1, int(np.ceil(pixel / edge_length - 0.25)))
    border = _border_points(padded, parts) * pixel + corner
    # distance of the inside to the outside, on a finer grid of pixels
    fine = 8
    distance = distance_transform_edt(np.kron(padded, np.ones((fine, fine)))) * pixel / fine
    upper = corner + pixel * np.array(padded.shape)
    lattice = _hexagonal(corner, upper, edge_length)
    at = np.clip(((lattice - corner) / pixel * fine).astype(int), 0, np.array(distance.shape) - 1)
    lattice = lattice[distance[at[:, 0], at[:, 1]] > 0.62 * max(pixel / parts, 0.9 * edge_length)]
    points = np.concatenate([border, lattice])
    triangles = Delaunay(points).simplices.astype(np.int64)
    centres = points[triangles].mean(axis=1)
    cell = np.clip(((centres - corner) / pixel).astype(int), 0, np.array(padded.shape) - 1)
    triangles = triangles[padded[cell[:, 0], cell[:, 1]]]
    a, b, c = (points[triangles[:, k]] for k in range(3))
    turn = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    triangles = np.where((turn < 0)[:, None], triangles[:, ::-1], triangles)[np.abs(turn) > 1e-9 * pixel**2]
    used, faces = np.unique(triangles, return_inverse=True)
    vertices = np.zeros((len(used), 3))
    vertices[:, :2] = points[used]
    return TriangleMesh(vertices, faces.reshape(-1, 3))


def _border_points(padded: Mask, parts: int) -> Floats:
    """Points on the pixel sides between inside and outside, in pixels."""
    pieces = []
    for axis in range(2):
        i, j = np.nonzero(np.diff(padded.astype(np.int8), axis=axis))
        start = np.stack([i, j], axis=1).astype(float)
        start[:, axis] += 1.0
        along = np.zeros(2)
        along[1 - axis] = 1.0
        pieces += [start + along * (k / parts) for k in range(parts + 1)]
    return np.unique(np.round(np.concatenate(pieces) * parts).astype(np.int64), axis=0) / parts


def _hexagonal(lower: Floats, upper: Floats, step: float) -> Floats:
    height = step * np.sqrt(0.75)
    rows, columns = int((upper[1] - lower[1]) / height) + 1, int((upper[0] - lower[0]) / step) + 1
    j, i = np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij")
    # turned a little, so that no four points lie on one circle with those of the boundary
    grid = np.stack([(i + 0.5 * (j % 2)).ravel() * step, j.ravel() * height], axis=1)
    return lower + grid + 0.013 * step * np.array([1.0, 0.7])
