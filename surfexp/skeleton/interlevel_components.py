"""The connected components of what lies between the levels of a function."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from surfexp.contract.arrays import Integers
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.union_find import find_root
from surfexp.skeleton.level_contours import LevelContours


@dataclass(frozen=True, eq=False)
class Slabs:
    """What lies between the contours.

    Parameters
    ----------
    vertex_component : (n,) int64
        The connected component of {level s - 1 <= f < level s} that each vertex lies in.
    below, above : (C,) int64
        The components on the two sides of each contour.
    count : int
        Number of components; one without a vertex is counted too.
    """

    vertex_component: Integers
    below: Integers
    above: Integers
    count: int


def slab_components(mesh: TriangleMesh, contours: LevelContours) -> Slabs:
    """Connected components of the slabs between levels, in time linear in the crossed faces.

    Within a slab, neighbouring pieces of faces share a vertex or a crossing of a contour; so vertices and the two sides of
    every contour are joined, face by face, and no piece is ever made.
    """
    n, count = len(mesh.vertices), len(contours.level)
    roots = _join(mesh.faces, contours.vertex_slabs, contours.face_starts, contours.face_contours, count)
    used = np.zeros(n, dtype=bool)
    used[mesh.faces] = True
    member = np.concatenate([np.flatnonzero(used), np.arange(n, n + 2 * count)])
    found, labels = np.unique(roots[member], return_inverse=True)
    component = np.full(len(roots), -1, dtype=np.int64)
    component[member] = labels.ravel()
    return Slabs(component[:n], component[n : n + count], component[n + count :], len(found))


@njit(cache=True, nogil=True)
def _join(
    faces: Integers, slabs: Integers, face_starts: Integers, face_contours: Integers, contour_count: int
) -> Integers:
    """Roots of vertices, then of the lower sides of the contours, then of their upper sides."""
    n = len(slabs)
    parents = np.arange(n + 2 * contour_count)
    for f in range(len(faces)):
        low = min(slabs[faces[f, 0]], slabs[faces[f, 1]], slabs[faces[f, 2]])
        crossings = face_starts[f + 1] - face_starts[f]
        for s in range(crossings + 1):
            first = -1
            for member in range(5):
                if member < 3:
                    item = faces[f, member] if slabs[faces[f, member]] == low + s else -1
                elif member == 3:
                    # the slab lies above its lower contour and below its upper one
                    item = n + contour_count + face_contours[face_starts[f] + s - 1] if s > 0 else -1
                else:
                    item = n + face_contours[face_starts[f] + s] if s < crossings else -1
                if item < 0:
                    continue
                root = find_root(parents, item)
                if first < 0:
                    first = root
                elif root != first:
                    a, b = min(root, first), max(root, first)
                    parents[b] = a
                    first = a
    for i in range(len(parents)):
        parents[i] = find_root(parents, i)
    return parents
