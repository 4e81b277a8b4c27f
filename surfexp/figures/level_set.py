"""Level sets of a function that is linear on every face: polygonal lines on the surface."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.triangle_mesh import TriangleMesh


@dataclass(frozen=True, eq=False)
class LevelSet:
    """The line on which a linear function takes one value.

    Parameters
    ----------
    points : (p, 3) float64
        One on each edge that the line crosses.
    segments : (s, 2) int64
        Indices of points, one segment in each face that the line crosses; higher values are on the left.
    faces : (s,) int64
        The face of each segment.
    """

    points: Floats
    segments: Integers
    faces: Integers

    @cached_property
    def length(self) -> float:
        """Total length, in the unit of the surface."""
        ends = self.points[self.segments]
        return float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum())

    @cached_property
    def lines(self) -> list[Integers]:
        """Chains of point indices, longest first; a closed one repeats its first point at its end."""
        following: dict[int, list[int]] = {}
        for a, b in self.segments.tolist():
            following.setdefault(a, []).append(b)
        heads = np.setdiff1d(self.segments[:, 0], self.segments[:, 1]).tolist()
        lines = []
        # open lines first, from their heads; what then remains is closed
        for start in [*heads, *self.segments[:, 0].tolist()]:
            line = [start]
            while following.get(line[-1]):
                line.append(following[line[-1]].pop())
            if len(line) > 1:
                lines.append(np.array(line, dtype=np.int64))
        return sorted(lines, key=len, reverse=True)


def level_set(mesh: TriangleMesh, values: Floats, level: float) -> LevelSet:
    """The line {values = level} of the linear interpolation of values at the vertices.

    A vertex exactly at the level counts as above it, so that the line never ends inside the surface. By the co-area
    formula the integral of its length over all levels is the total variation, exactly. Faces with a vertex that is not
    finite carry no line.

    Raises
    ------
    ValueError
        If there is not one value for each vertex.
    """
    if np.shape(values) != (len(mesh.vertices),):
        raise ValueError(f"values have shape {np.shape(values)}, the mesh has {len(mesh.vertices)} vertices")
    corner_values = values[mesh.faces]
    above = corner_values >= level
    crossed = (above != np.roll(above, -1, axis=1)) & np.isfinite(corner_values).all(axis=1, keepdims=True)
    faces = np.flatnonzero(crossed.any(axis=1))
    edges, inverse = np.unique(mesh.face_edges[faces][crossed[faces]], return_inverse=True)
    start, end = mesh.edges[edges].T
    share = (level - values[start]) / (values[end] - values[start])
    points = (1.0 - share)[:, None] * mesh.vertices[start] + share[:, None] * mesh.vertices[end]
    segments = inverse.reshape(-1, 2)
    # exactly one of the two crossed sides, walked counter-clockwise, leads from above to below: the line enters there
    descending = (above & crossed)[faces][crossed[faces]].reshape(-1, 2)
    segments = np.where(descending[:, :1], segments, segments[:, ::-1])
    return LevelSet(points, segments.astype(np.int64), faces.astype(np.int64))
