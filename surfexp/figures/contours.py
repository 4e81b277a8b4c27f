"""Level sets drawn on a picture of a surface, as lines of one width on the screen."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats
from surfexp.figures.camera import Camera
from surfexp.figures.level_set import level_set
from surfexp.figures.rasterizer import Raster
from surfexp.mesh.triangle_mesh import TriangleMesh

RED = "#d7191c"
# slopes of the surface against the screen between which a line is taken to lie on the surface behind it
SLOPES = (1.0, 4.0)


@dataclass(frozen=True, eq=False)
class Contours:
    """Lines of constant value of a function on a surface.

    Parameters
    ----------
    field : (n,) float64
        The function, linear on every face. For a labelling 0, 1 the level 0.5 is its border.
    levels : tuple of float
    color : str
        As matplotlib names it.
    width : float
        In pixels of the picture.
    """

    field: Floats
    levels: tuple[float, ...] = (0.0,)
    color: str = RED
    width: float = 2.0


def contour_coverage(mesh: TriangleMesh, contours: Contours, camera: Camera, raster: Raster) -> NDArray[np.float64]:
    """(height, width) share of each pixel under the visible lines, softened over one pixel at their borders.

    Every segment of the level set is drawn with round ends, so that the line has no gap where it passes from face to
    face. A pixel takes it only if the surface in that pixel is, within the slope of the face, as deep as the line.

    Parameters
    ----------
    contours : Contours
        With its width in pixels of the raster.
    """
    coverage = np.zeros(raster.face.shape)
    facing = np.abs(mesh.face_normals @ camera.axes[2])
    slope = np.clip(np.sqrt(np.maximum(1.0 - facing**2, 0.0)) / np.maximum(facing, 1e-6), *SLOPES)
    for level in contours.levels:
        line = level_set(mesh, contours.field, level)
        screen, depth, _ = camera.project(line.points)
        slack = slope[line.faces] / camera.scale
        _draw(screen[line.segments], depth[line.segments], slack, raster.depth, 0.5 * contours.width, coverage)
    return coverage


@njit(cache=True, nogil=True)
def _draw(ends: Floats, behind: Floats, slack: Floats, depth: Floats, radius: float, coverage: Floats) -> None:
    """Draw capsules around segments; slack is the change of depth that one pixel of distance allows."""
    height, width = depth.shape
    reach = radius + 0.5
    for s in range(len(ends)):
        ax, ay, bx, by = ends[s, 0, 0], ends[s, 0, 1], ends[s, 1, 0], ends[s, 1, 1]
        if not np.isfinite(ax + ay + bx + by):
            continue
        dx, dy = bx - ax, by - ay
        squared = dx * dx + dy * dy
        for row in range(max(int(min(ay, by) - reach), 0), min(int(max(ay, by) + reach) + 1, height)):
            for column in range(max(int(min(ax, bx) - reach), 0), min(int(max(ax, bx) + reach) + 1, width)):
                x, y = column + 0.5 - ax, row + 0.5 - ay
                share = min(max((x * dx + y * dy) / squared, 0.0), 1.0) if squared > 0.0 else 0.0
                distance = np.hypot(x - share * dx, y - share * dy)
                if distance >= reach:
                    continue
                difference = depth[row, column] - (1.0 - share) * behind[s, 0] - share * behind[s, 1]
                if abs(difference) <= slack[s] * (distance + 1.5):
                    coverage[row, column] = max(coverage[row, column], min(reach - distance, 1.0))
