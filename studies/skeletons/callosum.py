"""Synthetic corpora callosa: patches with a known midline and the staircase edge of a manual mask."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.shapes.planar_patch import triangulate_region
from surfexp.mesh.surface import Surface, Truth

from .callosum_shape import callosum_shape
from .planted_map import planted_map


def callosum(
    seed: int = 0,
    thinning: float = 0.0,
    edge_length: float = 0.6,
    pixel: float = 0.7,
    turn: float = 0.0,
    signal: float | None = None,
) -> Surface:
    """Synthetic corpus callosum: a flat patch with the staircase edge of a mask, some 2,000 vertices; x is forward, y up, in mm.

    Parameters
    ----------
    seed, thinning
        As in `callosum_shape`; they are repeated in the metrics.
    edge_length, pixel : float
        Of the triangles, and of the mask, in mm.
    turn : float
        Degrees by which the mask's grid is turned against the shape, for another staircase.
    signal : float, optional
        Height of the bump in a synthetic map, which becomes the scalar map "signal", as in `planted_map`.

    Raises
    ------
    ValueError
        If the pixels are too large for the rostrum.
    """
    if not 0 < pixel <= 1.5 or not 0.05 <= edge_length <= 2.0:
        raise ValueError(f"pixel = {pixel} and edge_length = {edge_length}; take 0 < pixel <= 1.5 and 0.05..2")
    shape = callosum_shape(seed, thinning)
    angle = np.radians(turn)
    rotation = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    midline = shape.midline @ rotation.T

    def inside(points: Floats) -> Floats:
        from scipy.spatial import cKDTree

        found = np.zeros(len(points), dtype=bool)
        tree = cKDTree(points)
        for centre, radius in zip(midline[::2], shape.half_width[::2], strict=True):
            found[tree.query_ball_point(centre, radius)] = True
        return found

    reach = 1.1 * shape.half_width.max()
    mesh = triangulate_region(inside, midline.min(axis=0) - reach, midline.max(axis=0) + reach, pixel, edge_length)
    back = np.eye(3)
    back[:2, :2] = rotation
    mesh = type(mesh)(mesh.vertices @ back, mesh.faces)
    known = {"seed": float(seed), "thinning": thinning}
    scalars = {}
    if signal is not None:
        scalars["signal"] = planted_map(mesh.vertices[:, :2], shape, signal, seed)
    flat = mesh.vertices[:, :2]
    line = np.concatenate([shape.midline, np.zeros((len(shape.midline), 1))], axis=1)
    truth = Truth(midline=line)
    return with_metrics(Surface(mesh, f"callosum {seed}", "mm", scalars, coordinates=flat, metrics=known, truth=truth))
