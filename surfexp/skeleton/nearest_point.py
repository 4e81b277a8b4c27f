"""The point of a triangle that is nearest to a point in space."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats


def nearest_on_triangles(points: Floats, corners: Floats) -> Floats:
    """Nearest point of each of p triangles to its own point.

    It is the foot of the perpendicular where that lies inside, else the nearest of the nearest points of the three sides.

    Parameters
    ----------
    points : (p, 3) float64
    corners : (p, 3, 3) float64
        Corners of each triangle; one without area counts by its sides.

    Returns
    -------
    (p, 3) float64
    """
    sides = np.roll(corners, -1, axis=1) - corners
    offsets = points[:, None, :] - corners
    squares = np.einsum("psx,psx->ps", sides, sides)
    along = np.einsum("psx,psx->ps", offsets, sides) / np.maximum(squares, 1e-300)
    candidates = corners + np.clip(along, 0.0, 1.0)[..., None] * sides
    normals = np.cross(sides[:, 0], sides[:, 1])
    areas = np.einsum("px,px->p", normals, normals)
    height = np.einsum("px,px->p", offsets[:, 0], normals) / np.maximum(areas, 1e-300)
    feet = points - height[:, None] * normals
    turns = np.cross(sides, feet[:, None, :] - corners)
    inside = (np.einsum("psx,px->ps", turns, normals) >= 0).all(axis=1) & (areas > 0)
    distances = np.linalg.norm(points[:, None, :] - candidates, axis=2)
    on_sides = candidates[np.arange(len(points)), distances.argmin(axis=1)]
    return np.where(inside[:, None], feet, on_sides)
