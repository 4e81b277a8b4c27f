"""A cup with one handle: a closed surface of genus one."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.shapes.implicit_surface import mesh_implicit, smooth_intersection, smooth_union
from surfexp.mesh.surface import Surface


def cup_function(points: Floats) -> Floats:
    """Negative inside the clay of the cup, about the signed distance near its surface.

    The outer wall is exactly the cylinder of radius 1 for -1.1 < z < 1.1 away from the handle, which is on the side of
    positive x.
    """
    x, y, z = points.T
    rho = np.hypot(x, y)
    body = smooth_intersection(rho - 1.0, np.abs(z) - 1.3, 0.3)
    hollow = smooth_intersection(rho - 0.76, -0.6 - z, 0.4)
    ring = np.hypot(x - 1.05, 0.8 * (z - 0.0))
    handle = np.hypot(ring - 0.62, y) - 0.14
    return smooth_intersection(smooth_union(body, handle, 0.2), -hollow, 0.16)


def cup(count: int = 25075) -> Surface:
    """Cup of outer radius 1 and height 2.6 with a hollow and one handle (figures 2.2 and 2.3); closed, genus 1.

    Parameters
    ----------
    count : int
        Number of vertices, at least 2000, which is what the handle needs.

    Raises
    ------
    ValueError
        If the count is under 2000.
    """
    if count < 2000:
        raise ValueError(f"cup has count = {count}; at least 2000 vertices are needed to resolve wall and handle")
    spacing = min(5.8 / np.sqrt(count), 0.07)
    mesh = mesh_implicit(cup_function, [-1.1, -1.1, -1.4], [2.0, 1.1, 1.4], spacing, count)
    return with_metrics(Surface(mesh, name="cup"))
