"""Sulcal regions of a cortex: segmentation of the mean curvature, its components, and their names by a template."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from surfexp.contract.arrays import Floats, Integers
from surfexp.embedding.nearest import nearest
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import fem
from surfexp.operators.mean_curvature import mean_curvature
from surfexp.variational.image import Image
from surfexp.variational.models.convex_chan_vese import ConvexChanVese
from surfexp.variational.solvers.primal_dual import primal_dual

OUTSIDE = -1


def components(mesh: TriangleMesh, inside: NDArray[np.bool_], smallest_area: float = 0.0) -> Integers:
    """Return the number of the connected piece of each vertex inside, largest area first, -1 outside or in small pieces.

    Parameters
    ----------
    mesh : TriangleMesh
    inside : (n,) bool
    smallest_area : float
        Pieces below it are left out.
    """
    inside = np.asarray(inside, dtype=bool)
    n = len(mesh.vertices)
    if inside.shape != (n,):
        raise ValueError(f"the mask has shape {inside.shape}, the mesh has {n} vertices")
    edges = mesh.edges[inside[mesh.edges].all(axis=1)]
    graph = coo_array((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(n, n))
    pieces = connected_components(graph, directed=False)[1]
    areas = np.bincount(pieces, mesh.vertex_areas * inside)
    kept = [piece for piece in np.argsort(-areas, kind="stable") if areas[piece] > smallest_area]
    numbers = np.full(len(areas), OUTSIDE, np.int64)
    numbers[kept] = np.arange(len(kept))
    return np.where(inside, numbers[pieces], OUTSIDE)


def bounded_curvature(mesh: TriangleMesh) -> Floats:
    """Return the mean curvature, positive in sulci, clipped at the 99th percentile of its size."""
    curvature = -mean_curvature(mesh)
    bound = float(np.percentile(np.abs(curvature), 99.0))
    return np.clip(curvature, -bound, bound)


def sulcal_regions(mesh: TriangleMesh, smoothness: float = 0.3, smallest_share: float = 1.5e-3) -> Integers:
    """Return the sulcal regions of a cortex (6.20): pieces of the convex Chan-Vese segmentation of its mean curvature.

    Parameters
    ----------
    mesh : TriangleMesh
        Closed, oriented outwards.
    smoothness : float
        Weight of the boundary, see `ConvexChanVese`.
    smallest_share : float
        Pieces under this share of the surface's area are left out.

    Returns
    -------
    (n,) int64
        Number of the region, largest first; -1 on gyri.
    """
    # the sharpest folds lead the two means: what is left are the floors of sulci, apart from each other, which lengths need
    image = Image(bounded_curvature(mesh), "mean curvature")
    solution = ConvexChanVese(smoothness).run(image, fem(mesh), primal_dual)
    return components(mesh, solution.values > 0.5, smallest_share * mesh.area)


def names_by_majority(regions: Integers, areas: Floats, template: Integers, rows: Integers) -> Integers:
    """Return for each region the template region that most of its area is mapped to.

    Parameters
    ----------
    regions, areas : (t,) int64, (t,) float64
        Of the target: number of the region or -1, and vertex areas.
    template : (s,) int64
        Regions of the template.
    rows : (t,) int64
        Template vertex of each target vertex.

    Returns
    -------
    (r,) int64
        -1 where nothing of the region is mapped into a region.
    """
    count, known = int(regions.max()) + 1, int(template.max()) + 1
    votes = np.zeros((count, known))
    hit = (regions >= 0) & (template[rows] >= 0)
    np.add.at(votes, (regions[hit], template[rows][hit]), areas[hit])
    return np.where(votes.sum(axis=1) > 0, votes.argmax(axis=1), OUTSIDE)


def names_by_distance(
    regions: Integers,
    areas: Floats,
    points: Floats,
    template: Integers,
    template_areas: Floats,
    template_points: Floats,
) -> Integers:
    """Return for each region the template region of least spectral pre-distance (6.7), the rule published in 6.4.2.

    Parameters
    ----------
    regions, areas, points : (t,) int64, (t,) float64, (t, n) float64
        Of the target, embedded in the optimal basis.
    template, template_areas, template_points
        Of the template.
    """
    count, known = int(regions.max()) + 1, int(template.max()) + 1
    table = np.empty((count, known))
    for j in range(known):
        other = template == j
        forward = nearest(points, template_points[other])[1]
        for i in range(count):
            own = regions == i
            backward = nearest(template_points[other], points[own])[1]
            there = float(np.average(forward[own], weights=areas[own]))
            table[i, j] = max(there, float(np.average(backward, weights=template_areas[other])))
    return np.asarray(table.argmin(axis=1))


def naming_accuracy(names: Integers, truth: Integers, regions: Integers, areas: Floats) -> float:
    """Return the share of the area of all regions whose name is the true one; regions without a true name do not count."""
    weights = np.bincount(regions[regions >= 0], areas[regions >= 0], len(names))
    known = truth >= 0
    total = float(weights[known].sum())
    return float(weights[known & (names == truth)].sum()) / total if total > 0 else 0.0
