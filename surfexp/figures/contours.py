"""Level sets drawn on a picture of a surface, as lines of one width on the screen."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats
from surfexp.figures.camera import Camera
from surfexp.figures.level_set import level_set
from surfexp.figures.lines import CASING, Lines
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
    casing : float
        As in `Lines`.
    """

    field: Floats
    levels: tuple[float, ...] = (0.0,)
    color: str = RED
    width: float = 2.0
    casing: float = CASING

    def lines(self, mesh: TriangleMesh) -> Lines:
        """Return the segments of all levels.

        Parameters
        ----------
        mesh : TriangleMesh

        Returns
        -------
        Lines
        """
        points, segments, faces, count = [np.zeros((0, 3))], [np.zeros((0, 2), np.int64)], [np.zeros(0, np.int64)], 0
        for level in self.levels:
            line = level_set(mesh, self.field, level)
            points.append(line.points)
            segments.append(line.segments + count)
            faces.append(line.faces)
            count += len(line.points)
        joined = np.concatenate(segments)
        return Lines(
            np.concatenate(points), joined, self.color, self.width, casing=self.casing, faces=np.concatenate(faces)
        )


def line_coverage(
    mesh: TriangleMesh, lines: Lines, width: float, camera: Camera, raster: Raster
) -> NDArray[np.float64]:
    """(height, width) share of each pixel under the visible lines, softened over one pixel at their borders.

    Every segment is drawn with round ends, so that the line has no gap where it passes from face to face. A pixel takes
    it only if the surface in that pixel is, within the slope of the face, as deep as the line, or if it is seen through
    the surface.

    Parameters
    ----------
    mesh : TriangleMesh
    lines : Lines
    width : float
        In pixels of the raster.
    camera : Camera
    raster : Raster
    """
    coverage = np.zeros(raster.face.shape)
    slack = np.full(len(lines.segments), np.inf if lines.through else SLOPES[1] / camera.scale)
    if lines.faces is not None and not lines.through:
        facing = np.abs(mesh.face_normals[lines.faces] @ camera.axes[2])
        slope = np.sqrt(np.maximum(1.0 - facing**2, 0.0)) / np.maximum(facing, 1e-6)
        slack = np.clip(slope, *SLOPES) / camera.scale
    screen, depth, _ = camera.project(lines.points)
    _draw(screen[lines.segments], depth[lines.segments], slack, raster.depth, 0.5 * width, coverage)
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
                if slack[s] == np.inf or abs(difference) <= slack[s] * (distance + 1.5):
                    coverage[row, column] = max(coverage[row, column], min(reach - distance, 1.0))
