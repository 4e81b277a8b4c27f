"""Nets of tubes of one radius, whose axes and loops are known, and how near a skeleton is to them."""

from __future__ import annotations

from dataclasses import dataclass

import networkx
import numpy as np
from numpy.typing import NDArray
from skimage.measure import marching_cubes

from surfexp.contract.arrays import Floats
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.tasks.repairing import repair

EDGES_KEPT, MARGIN = 0.75, 0.4
# between these shares of its length a tube is far from what it meets
MIDDLE = (0.3, 0.7)


@dataclass(frozen=True, eq=False)
class NetOfTubes:
    """Tubes along some edges of a lattice.

    Parameters
    ----------
    mesh : TriangleMesh
        The boundary.
    inside : (i, j, k) bool
        The voxels inside; the first one's centre is at -0.4 in all directions.
    spacing : float
        Of the voxels.
    axes : (t, 2, 3) float64
        Ends of the axis of each tube.
    radius : float
    rings : int
        Independent loops.
    """

    mesh: TriangleMesh
    inside: NDArray[np.bool_]
    spacing: float
    axes: Floats
    radius: float
    rings: int


def net_of_tubes(seed: int, radius: float, spacing: float) -> NetOfTubes:
    """Return tubes along three quarters of the edges of a lattice of 2 x 2 x 3 points, their largest connected part."""
    random = np.random.default_rng(seed)
    lattice = networkx.grid_graph((2, 2, 3))
    chosen = lattice.edge_subgraph([edge for edge in sorted(lattice.edges) if random.random() < EDGES_KEPT])
    graph = chosen.subgraph(max(networkx.connected_components(chosen), key=len))
    axes = np.array(list(graph.edges), dtype=np.float64)
    grid = [np.arange(-MARGIN, size - 1.0 + MARGIN + 1e-9, spacing) for size in (3, 2, 2)]
    points = np.stack(np.meshgrid(*grid, indexing="ij"), axis=-1)
    distance = np.full(points.shape[:3], np.inf)
    for start, end in axes:
        distance = np.minimum(distance, distance_to_axis(points, start, end)[0])
    vertices, faces, _, _ = marching_cubes(radius - distance, 0.0, allow_degenerate=False)
    cut = (vertices.astype(np.float64) * spacing - MARGIN, faces[:, ::-1].astype(np.int64))
    rings = graph.number_of_edges() - len(graph) + 1
    return NetOfTubes(repair(cut).mesh, distance < radius, spacing, axes, radius, rings)


def distance_to_axis(points: Floats, start: Floats, end: Floats) -> tuple[Floats, Floats]:
    """Distance of points from a line segment, and how far along it they lie as a share of its length."""
    step = end - start
    share = (points - start) @ step / (step @ step)
    nearest = start + np.clip(share, 0.0, 1.0)[..., None] * step
    return np.linalg.norm(points - nearest, axis=-1), share


def errors_of_tubes(net: NetOfTubes, positions: Floats, radii: Floats) -> tuple[Floats, Floats]:
    """Return for each tube the error of the median radius in its middle, and how far its skeleton is from the axis there.

    Both are in radii, and infinite where a tube has no node of the skeleton in its middle.
    """
    found = [distance_to_axis(positions, start, end) for start, end in net.axes]
    nearest = np.argmin([distance for distance, _ in found], axis=0)
    radius_errors, offsets = np.full(len(found), np.inf), np.full(len(found), np.inf)
    for tube, (distance, share) in enumerate(found):
        there = (nearest == tube) & (share > MIDDLE[0]) & (share < MIDDLE[1]) & np.isfinite(radii)
        if there.any():
            radius_errors[tube] = abs(np.median(radii[there]) / net.radius - 1.0)
            offsets[tube] = np.median(distance[there]) / net.radius
    return radius_errors, offsets
