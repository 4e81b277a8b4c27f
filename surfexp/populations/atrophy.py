"""Synthetic loss of tissue: a smooth dent at one end of a surface, for tests of what a group study can find."""

from __future__ import annotations

import numpy as np

from surfexp.anatomy.enclosed_volume import enclosed_volume
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh


def with_atrophy(surface: Surface, depth: float, reach: float = 0.25) -> Surface:
    """Move vertices inward near the end of the longest axis, by `depth` at the tip, fading like a Gaussian.

    This is planted and clearly synthetic: no disease looks like it.

    Parameters
    ----------
    surface : Surface
    depth : float
        In the unit of the surface, not negative.
    reach : float
        Standard deviation of the fading, as a share of the length along the axis.

    Returns
    -------
    Surface
        With the metric tissue_lost, the share of the enclosed volume that went.

    Raises
    ------
    ValueError
        If depth or reach is out of bounds.
    """
    if depth < 0 or reach <= 0:
        raise ValueError(f"depth = {depth:g}, reach = {reach:g}: depth must not be negative, reach above 0")
    mesh = surface.mesh
    centred = mesh.vertices - mesh.vertices.mean(axis=0)
    axis = np.linalg.svd(centred, full_matrices=False)[2][0]
    # the front end in scanner coordinates: towards larger y, or x or z where that does not decide
    axis = axis if axis[np.argmax(np.abs(axis) * [1.0, 2.0, 1.0])] > 0 else -axis
    height = centred @ axis
    from_tip = (height.max() - height) / np.ptp(height)
    inward = depth * np.exp(-0.5 * (from_tip / reach) ** 2)
    moved = TriangleMesh(mesh.vertices - inward[:, None] * mesh.vertex_normals, mesh.faces)
    lost = 1.0 - enclosed_volume(moved) / enclosed_volume(mesh)
    name = f"{surface.name} with a planted dent of {depth:g} {surface.unit}".strip()
    metrics = {**surface.metrics, "tissue_lost": float(lost)}
    notes = (*surface.notes, "The loss of tissue is planted and synthetic.")
    return with_metrics(Surface(moved, name, surface.unit, surface.scalars, metrics=metrics, notes=notes))
