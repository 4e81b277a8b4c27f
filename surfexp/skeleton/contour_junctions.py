"""Where the nodes between contours stand: caps at extrema, junctions amid the contours that meet."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.skeleton.interlevel_components import Slabs
from surfexp.skeleton.level_contours import LevelContours
from surfexp.skeleton.nearest_point import nearest_on_triangles
from surfexp.skeleton.skeleton import CAP, JUNCTION


def hub_nodes(
    mesh: TriangleMesh, values: Floats, contours: LevelContours, slabs: Slabs, middles: Floats, hubs: Integers
) -> tuple[Floats, Floats, Integers]:
    """Positions, values and kinds of the slab components that are nodes.

    A cap sits at its extremal vertex, and so does a whole component of the surface that no level cuts. A junction sits at
    the mean of the contours' points that it joins, with the mean of their levels; where open contours meet, whose points
    lie on the surface, it is moved to the nearest point of the faces of its component.

    Parameters
    ----------
    middles : (C, 3) float64
        The point that stands for each contour.
    hubs : (h,) int64
        Components that are nodes.
    """
    positions, hub_values = np.zeros((slabs.count, 3)), np.zeros(slabs.count)
    degrees, opened = np.zeros(slabs.count, dtype=np.int64), np.zeros(slabs.count, dtype=bool)
    for side in (slabs.below, slabs.above):
        np.add.at(positions, side, middles)
        np.add.at(hub_values, side, contours.levels[contours.level])
        np.add.at(degrees, side, 1)
        opened[side[~contours.closed]] = True
    positions /= np.maximum(degrees, 1)[:, None]
    hub_values /= np.maximum(degrees, 1)
    kinds = np.where(degrees > 1, JUNCTION, CAP)
    moved = hubs[(degrees[hubs] > 1) & opened[hubs]]
    positions[moved] = _on_component(mesh, slabs, moved, positions[moved])
    caps = hubs[degrees[hubs] <= 1]
    extremal = _extremal_vertices(values, slabs)[caps]
    positions[caps], hub_values[caps] = mesh.vertices[extremal], values[extremal]
    return positions[hubs], hub_values[hubs], kinds[hubs]


def _extremal_vertices(values: Floats, slabs: Slabs) -> Integers:
    """The lowest vertex of a component below a contour, the highest of any other."""
    upward = np.ones(slabs.count, dtype=bool)
    upward[slabs.below] = False
    order = np.argsort(values, kind="stable")
    order = order[slabs.vertex_component[order] >= 0]
    highest, lowest = np.zeros(slabs.count, dtype=np.int64), np.zeros(slabs.count, dtype=np.int64)
    highest[slabs.vertex_component[order]] = order
    lowest[slabs.vertex_component[order[::-1]]] = order[::-1]
    return np.where(upward, highest, lowest)


def _on_component(mesh: TriangleMesh, slabs: Slabs, components: Integers, points: Floats) -> Floats:
    """Points moved to the nearest faces that touch a vertex of their component; as they were where it has no vertex."""
    row = np.full(slabs.count + 1, -1, dtype=np.int64)
    row[components] = np.arange(len(components))
    rows = row[slabs.vertex_component[mesh.faces]]
    face, corner = np.nonzero(rows >= 0)
    point = rows[face, corner]
    found = nearest_on_triangles(points[point], mesh.vertices[mesh.faces[face]])
    distances = np.linalg.norm(found - points[point], axis=1)
    # the nearest of each point comes last and stays
    order = np.argsort(-distances, kind="stable")
    moved = points.copy()
    moved[point[order]] = found[order]
    return moved
