"""The z-buffer: which face is seen in each pixel, and where in the face.

By hand: matplotlib sorts whole faces by depth, which is wrong where they overlap, and VTK or pyrender need OpenGL, which a server
without a display lacks. This takes .12 s for 81,920 faces on 1600 x 1200 pixels.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numba import njit
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats, Integers
from surfexp.figures.camera import Camera
from surfexp.mesh.triangle_mesh import TriangleMesh

# inclusive edges: a pixel centre on a shared edge may round to either side, and must not fall between both faces
EDGE_TOLERANCE = -1e-9


@dataclass(frozen=True, eq=False)
class Raster:
    """The visible surface at the centre of each pixel.

    Parameters
    ----------
    face : (height, width) int64
        Index of the nearest face, -1 where there is none.
    barycentric : (height, width, 3) float64
        Coordinates in that face, in space and not on the screen; zero where there is none.
    depth : (height, width) float64
        Distance behind the centre of the camera, in units of length; infinite where there is none.
    """

    face: Integers
    barycentric: Floats
    depth: Floats

    @cached_property
    def covered(self) -> NDArray[np.bool_]:
        """(height, width) whether a face is seen."""
        return self.face >= 0

    def interpolate(self, mesh: TriangleMesh, values: Floats) -> Floats:
        """(p,) or (p, k) linear interpolation of values at the vertices, for the covered pixels in reading order."""
        columns = np.ascontiguousarray(values, dtype=np.float64).reshape(len(mesh.vertices), -1)
        result = _interpolate(self.face[self.covered], self.barycentric[self.covered], mesh.faces, columns)
        return result[:, 0] if np.ndim(values) == 1 else result


def rasterize(mesh: TriangleMesh, camera: Camera) -> Raster:
    """Draw the faces of a mesh into a z-buffer; both sides of a face are seen, the nearest face wins.

    Pixel (row, column) has its centre at (column + 1/2, row + 1/2). Of faces at exactly the same depth the first one is
    kept. Faces without area on the screen, with coordinates that are not finite or behind the eye are left out.
    """
    width, height = camera.size
    face = np.full((height, width), -1, dtype=np.int64)
    barycentric = np.zeros((height, width, 3))
    depth = np.full((height, width), np.inf)
    with np.errstate(invalid="ignore"):
        projected = camera.project(mesh.vertices)
    _fill(*projected, mesh.faces, face, barycentric, depth)
    return Raster(face, barycentric, depth)


@njit(cache=True, nogil=True, error_model="numpy")
def _fill(
    screen: Floats, behind: Floats, divisor: Floats, faces: Integers, face: Integers, barycentric: Floats, depth: Floats
) -> None:
    height, width = face.shape
    for t in range(len(faces)):
        a, b, c = faces[t]
        ax, ay, bx, by, cx, cy = screen[a, 0], screen[a, 1], screen[b, 0], screen[b, 1], screen[c, 0], screen[c, 1]
        twice_area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if twice_area == 0.0 or not np.isfinite(twice_area) or min(divisor[a], divisor[b], divisor[c]) <= 0.0:
            continue
        scale = 1.0 / twice_area
        first_column = int(np.ceil(max(min(ax, bx, cx) - 0.5, 0.0)))
        last_column = int(np.floor(min(max(ax, bx, cx) - 0.5, width - 1.0)))
        first_row = int(np.ceil(max(min(ay, by, cy) - 0.5, 0.0)))
        last_row = int(np.floor(min(max(ay, by, cy) - 0.5, height - 1.0)))
        for row in range(first_row, last_row + 1):
            y = row + 0.5
            for column in range(first_column, last_column + 1):
                x = column + 0.5
                u = ((bx - x) * (cy - y) - (by - y) * (cx - x)) * scale
                v = ((cx - x) * (ay - y) - (cy - y) * (ax - x)) * scale
                w = 1.0 - u - v
                if u < EDGE_TOLERANCE or v < EDGE_TOLERANCE or w < EDGE_TOLERANCE:
                    continue
                # linear on the screen is 1/divisor; this makes the coordinates linear in space
                u, v, w = u / divisor[a], v / divisor[b], w / divisor[c]
                total = u + v + w
                u, v, w = u / total, v / total, w / total
                z = u * behind[a] + v * behind[b] + w * behind[c]
                if z < depth[row, column]:
                    depth[row, column] = z
                    face[row, column] = t
                    barycentric[row, column, 0] = u
                    barycentric[row, column, 1] = v
                    barycentric[row, column, 2] = w


@njit(cache=True, nogil=True, error_model="numpy")
def _interpolate(face: Integers, barycentric: Floats, faces: Integers, values: Floats) -> Floats:
    result = np.zeros((len(face), values.shape[1]))
    for p in range(len(face)):
        for k in range(3):
            vertex = faces[face[p], k]
            for j in range(values.shape[1]):
                result[p, j] += barycentric[p, k] * values[vertex, j]
    return result
