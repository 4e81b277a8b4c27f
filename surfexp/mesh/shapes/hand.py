"""An open hand with five fingers, cut off at the wrist."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.shapes.implicit_surface import mesh_implicit
from surfexp.mesh.shapes.round_cones import round_cones
from surfexp.mesh.surface import Surface

FLATNESS = 0.8
# start x y z, end x y z, radii at both, width of the blend; the palm faces -y, the thumb is at positive x
# fmt: off
BONES = np.array([
    [0.00, 0.00, -0.60,   0.00, 0.00, 0.45,  0.33, 0.36, 0.10],
    [0.10, 0.00,  0.50,   0.34, 0.00, 1.38,  0.27, 0.19, 0.20],
    [0.04, 0.00,  0.50,   0.11, 0.00, 1.43,  0.27, 0.19, 0.20],
    [-0.04, 0.00, 0.50,  -0.13, 0.00, 1.38,  0.27, 0.18, 0.20],
    [-0.10, 0.00, 0.50,  -0.36, 0.00, 1.26,  0.27, 0.16, 0.20],
    [0.34, 0.00,  1.40,   0.46, -0.02, 1.92,  0.165, 0.135, 0.06],
    [0.46, -0.02, 1.92,   0.53, -0.12, 2.34,  0.135, 0.105, 0.04],
    [0.11, 0.00,  1.45,   0.13, -0.02, 2.08,  0.165, 0.140, 0.06],
    [0.13, -0.02, 2.08,   0.14, -0.13, 2.56,  0.140, 0.110, 0.04],
    [-0.13, 0.00, 1.40,  -0.20, -0.02, 2.00,  0.160, 0.130, 0.06],
    [-0.20, -0.02, 2.00, -0.25, -0.12, 2.42,  0.130, 0.105, 0.04],
    [-0.36, 0.00, 1.28,  -0.53, -0.02, 1.74,  0.145, 0.115, 0.06],
    [-0.53, -0.02, 1.74, -0.63, -0.10, 2.06,  0.115, 0.095, 0.04],
    [0.12, -0.08, 0.48,   0.56, -0.16, 0.92,  0.25, 0.190, 0.20],
    [0.56, -0.16, 0.92,   0.82, -0.20, 1.24,  0.175, 0.155, 0.05],
    [0.82, -0.20, 1.24,   0.95, -0.22, 1.56,  0.155, 0.115, 0.04],
])
# fmt: on


def hand_function(points: Floats) -> Floats:
    """Negative inside the hand, which is somewhat flattened in y."""
    return round_cones(points * [1.0, 1.0 / FLATNESS, 1.0], BONES)


def hand(count: int = 58875) -> Surface:
    """Hand with five fingers and one boundary loop at the wrist, z = 0 (figure 2.5); genus 0, 2.7 units high.

    Parameters
    ----------
    count : int
        Number of vertices, at least 4000, which is what the gaps between the fingers need.

    Raises
    ------
    ValueError
        If the count is under 4000.
    """
    if count < 4000:
        raise ValueError(f"hand has count = {count}; at least 4000 vertices are needed to tell the fingers apart")
    spacing = max(4.0 / np.sqrt(count), 0.018)
    mesh = mesh_implicit(hand_function, [-0.9, -0.6, 0.0], [1.2, 0.5, 2.8], min(spacing, 0.04), count, open_floor=True)
    return with_metrics(Surface(mesh, name="hand"))
