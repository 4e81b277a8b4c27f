"""The geodesic distance to the boundary of a surface patch (5.6), by three methods."""

from __future__ import annotations

from importlib import import_module
from typing import Any, Literal, get_args

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.extras import require_installed
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.vertex_star import boundary_edges
from surfexp.skeleton.fast_marching import fast_marching

Method = Literal["fast_marching", "exact", "heat"]


def boundary_distance(mesh: TriangleMesh, method: Method = "fast_marching", halvings: int = 3) -> Floats:
    """Distance D of every vertex to the boundary (5.6).

    Parameters
    ----------
    mesh : TriangleMesh
        With a boundary.
    method : {"fast_marching", "exact", "heat"}
        Fast marching, of first order in the edge length; exact polyhedral distances (pygeodesic), with boundary edges
        halved `halvings` times, because that algorithm starts at vertices only; the heat method (potpourri3d).
    halvings : int

    Returns
    -------
    (n,) float64
        0 on the boundary.

    Raises
    ------
    ValueError
        If there is no boundary, or part of the surface has none, or the method is unknown.
    """
    boundary = boundary_vertices(mesh)
    if method not in get_args(Method):
        raise ValueError(f"distance method {method!r} is unknown, choose one of {', '.join(get_args(Method))}")
    reached = np.unique(mesh.component_labels[boundary])
    used = np.unique(mesh.component_labels[mesh.faces[:, 0]])
    if len(reached) < len(used):
        raise ValueError(
            f"{len(used) - len(reached)} of {len(used)} components are closed: remove them, D needs a boundary"
        )
    if method == "fast_marching":
        distance = fast_marching(mesh, boundary)
    elif method == "exact":
        distance = _exact(mesh, halvings)
    else:
        distance = _heat(mesh, boundary)
    distance[boundary] = 0.0
    return distance


def boundary_vertices(mesh: TriangleMesh) -> Integers:
    """Vertices on the boundary, increasing.

    Raises
    ------
    ValueError
        If there is no boundary.
    """
    edges = boundary_edges(mesh.faces, len(mesh.vertices))
    if not len(edges):
        raise ValueError(
            f"the surface of {len(mesh.vertices)} vertices is closed: the distance to its boundary, and with it the flux, "
            "needs a patch with a boundary"
        )
    return np.unique(edges)


def halve_boundary_edges(mesh: TriangleMesh, times: int) -> tuple[TriangleMesh, Integers]:
    """Split every boundary edge in two, some times over; the surface and its first n vertices stay as they are.

    Returns
    -------
    mesh : TriangleMesh
    boundary : (b,) int64
        Its boundary vertices.
    """
    for _ in range(times):
        edges = boundary_edges(mesh.faces, len(mesh.vertices))
        middle = {(a, b): len(mesh.vertices) + i for i, (a, b) in enumerate(edges.tolist())}
        touched = np.isin(mesh.faces, edges).sum(axis=1) >= 2
        faces = [tuple(face) for face in mesh.faces[~touched].tolist()]
        waiting = [tuple(face) for face in mesh.faces[touched].tolist()]
        while waiting:
            a, b, c = waiting.pop()
            for first, second, third in ((a, b, c), (b, c, a), (c, a, b)):
                if (first, second) in middle:
                    centre = middle[first, second]
                    waiting += [(first, centre, third), (centre, second, third)]
                    break
            else:
                faces.append((a, b, c))
        points = np.concatenate([mesh.vertices, mesh.vertices[edges].mean(axis=1)])
        mesh = TriangleMesh(points, np.array(faces, dtype=np.int64))
    return mesh, np.unique(boundary_edges(mesh.faces, len(mesh.vertices)))


def _exact(mesh: TriangleMesh, halvings: int) -> Floats:
    finer, boundary = halve_boundary_edges(mesh, halvings)
    require_installed("distance 'exact'", "pygeodesic")
    module: Any = import_module("pygeodesic.geodesic")
    algorithm = module.PyGeodesicAlgorithmExact(finer.vertices, finer.faces.astype(np.int32))
    distance, _ = algorithm.geodesicDistances(boundary.astype(np.int32), None)
    return np.array(distance[: len(mesh.vertices)], dtype=np.float64)


def _heat(mesh: TriangleMesh, boundary: Integers) -> Floats:
    require_installed("distance 'heat'", "potpourri3d")
    module: Any = import_module("potpourri3d")
    solver = module.MeshHeatMethodDistanceSolver(mesh.vertices, mesh.faces)
    return np.array(solver.compute_distance_multisource(boundary.tolist()), dtype=np.float64)
