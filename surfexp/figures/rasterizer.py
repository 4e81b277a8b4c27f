"""The z-buffer: which face is seen in each pixel, and where in the face.

By hand: matplotlib sorts whole faces by depth, which is wrong where they overlap, and VTK or pyrender need OpenGL, which a server
without a display lacks.
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
        screen, behind, divisor = camera.project(mesh.vertices)
    _fill(screen, behind, divisor, mesh.faces, face, depth)
    _locate(screen, divisor, mesh.faces, face, barycentric)
    return Raster(face, barycentric, depth)


@njit(cache=True, nogil=True, error_model="numpy")
def _fill(screen: Floats, behind: Floats, divisor: Floats, faces: Integers, face: Integers, depth: Floats) -> None:
    """Find the nearest face in each pixel: along a row all is linear, so that several columns are taken at once."""
    height, width = face.shape
    ramp = np.arange(width).astype(np.float64)
    for t in range(len(faces)):
        a, b, c = faces[t]
        ax, ay = screen[a, 0], screen[a, 1]
        bx, by, cx, cy = screen[b, 0] - ax, screen[b, 1] - ay, screen[c, 0] - ax, screen[c, 1] - ay
        twice_area = bx * cy - by * cx
        if twice_area == 0.0 or not np.isfinite(twice_area) or min(divisor[a], divisor[b], divisor[c]) <= 0.0:
            continue
        first_column = int(np.ceil(max(ax + min(0.0, bx, cx) - 0.5, 0.0)))
        last_column = int(np.floor(min(ax + max(0.0, bx, cx) - 0.5, width - 1.0)))
        first_row = int(np.ceil(max(ay + min(0.0, by, cy) - 0.5, 0.0)))
        last_row = int(np.floor(min(ay + max(0.0, by, cy) - 0.5, height - 1.0)))
        if first_column > last_column:
            continue
        # depth over divisor, and 1 over divisor, are linear on the screen; depth is their quotient
        over_a, over_b, over_c = 1.0 / divisor[a], 1.0 / divisor[b], 1.0 / divisor[c]
        deep_a, deep_b, deep_c = behind[a] * over_a, behind[b] * over_b, behind[c] * over_c
        # how v and w grow along a row and down a column, and by how many columns they grow by one
        step_v, step_w, down_v, down_w = cy / twice_area, -by / twice_area, -cx / twice_area, bx / twice_area
        step_u = -step_v - step_w
        run_u, run_v, run_w = 1.0 / step_u, 1.0 / step_v, 1.0 / step_w
        left, right = first_column + 0.5 - ax, last_column + 0.5 - ax
        for row in range(first_row, last_row + 1):
            y = row + 0.5 - ay
            start_v, start_w = y * down_v, y * down_w
            low, high = _where_positive(start_v, run_v, left, right)
            low, high = _where_positive(start_w, run_w, low, high)
            low, high = _where_positive(1.0 - start_v - start_w, run_u, low, high)
            first, last = int(low - left), int(high - left) + 2
            # slices, for numba takes several columns at once only where it sees that none is negative
            depths = depth[row, first_column + first : min(first_column + last, last_column + 1)]
            seen = face[row, first_column + first : min(first_column + last, last_column + 1)]
            for column in range(len(depths)):
                x = ramp[first + column] + left
                v, w = start_v + step_v * x, start_w + step_w * x
                u = 1.0 - v - w
                z = (u * deep_a + v * deep_b + w * deep_c) / (u * over_a + v * over_b + w * over_c)
                inside = (u >= EDGE_TOLERANCE) & (v >= EDGE_TOLERANCE) & (w >= EDGE_TOLERANCE)
                nearer = inside & (z < depths[column])
                depths[column] = z if nearer else depths[column]
                seen[column] = t if nearer else seen[column]


@njit(cache=True, nogil=True, error_model="numpy")
def _where_positive(start: float, run: float, low: float, high: float) -> tuple[float, float]:
    """Narrow an interval to where start + x / run >= 0, with half a pixel to spare; a point of it where that is nowhere."""
    if np.isinf(run):
        return low, high
    zero = -start * run
    return (min(max(low, zero - 0.5), high), high) if run > 0.0 else (low, max(min(high, zero + 0.5), low))


@njit(cache=True, nogil=True, error_model="numpy")
def _locate(screen: Floats, divisor: Floats, faces: Integers, face: Integers, barycentric: Floats) -> None:
    """Find where each pixel lies in its face."""
    for row in range(face.shape[0]):
        for column in range(face.shape[1]):
            t = face[row, column]
            if t < 0:
                continue
            a, b, c = faces[t]
            ax, ay = screen[a, 0], screen[a, 1]
            bx, by, cx, cy = screen[b, 0] - ax, screen[b, 1] - ay, screen[c, 0] - ax, screen[c, 1] - ay
            x, y, twice_area = column + 0.5 - ax, row + 0.5 - ay, bx * cy - by * cx
            v, w = (x * cy - y * cx) / twice_area, (bx * y - by * x) / twice_area
            # linear on the screen is 1/divisor; this makes the coordinates linear in space
            u, v, w = (1.0 - v - w) / divisor[a], v / divisor[b], w / divisor[c]
            share = 1.0 / (u + v + w)
            barycentric[row, column, 0] = u * share
            barycentric[row, column, 1] = v * share
            barycentric[row, column, 2] = w * share


@njit(cache=True, nogil=True, error_model="numpy")
def _interpolate(face: Integers, barycentric: Floats, faces: Integers, values: Floats) -> Floats:
    result = np.zeros((len(face), values.shape[1]))
    for p in range(len(face)):
        for k in range(3):
            vertex = faces[face[p], k]
            for j in range(values.shape[1]):
                result[p, j] += barycentric[p, k] * values[vertex, j]
    return result
