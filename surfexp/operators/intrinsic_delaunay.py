"""Finite elements on the intrinsic Delaunay triangulation of the same surface and vertices."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.edge_flips import flip_to_delaunay, triangle_areas, twin_sides
from surfexp.operators.fem import check_mesh
from surfexp.operators.surface_operator import SurfaceOperator

MOLLIFICATION = 1e-6


def intrinsic_delaunay(mesh: TriangleMesh) -> SurfaceOperator:
    """Return the linear finite element operator of the intrinsic Delaunay triangulation.

    Edges are flipped along the surface, known by their lengths alone, so the surface stays what it was. Lengths are first
    increased together until every triangle inequality holds by 1e-6 of the mean length, so slivers and faces without area are
    survived. Edges with more than two faces, or with faces that disagree in orientation, are kept.

    Parameters
    ----------
    mesh : TriangleMesh

    Returns
    -------
    SurfaceOperator
        Without frames. Metrics `flips` and `mollification` (the length added).

    Raises
    ------
    ValueError
        If there are no faces, a position is not finite, or a vertex belongs to no face.

    References
    ----------
    Fisher, Springborn, Schroeder, Bobenko: An algorithm for the construction of intrinsic Delaunay triangulations (2007).
    Sharp, Crane: A Laplacian for nonmanifold triangle meshes (2020), for the mollification.
    """
    check_mesh(mesh, flat_faces=True)
    corners = mesh.vertices[mesh.faces]
    lengths = np.linalg.norm(corners[:, [1, 2, 0]] - corners, axis=2)
    slack = lengths.sum(axis=1, keepdims=True) - 2.0 * lengths
    added = max(0.0, float(MOLLIFICATION * lengths.mean() - slack.min()))
    lengths += added
    faces = mesh.faces.copy()
    limit = 100 * len(faces)
    flips = flip_to_delaunay(faces, lengths, twin_sides(mesh.faces), limit)
    notes = (
        [] if flips < limit else [f"Flipping stopped at {limit} flips: the triangulation is not Delaunay everywhere."]
    )
    if added > 0:
        notes.append(f"Every edge was lengthened by {added:.3g} to open faces without area.")
    hat_gradients, areas = hat_gradients_from_lengths(lengths)
    metrics = {"flips": float(flips), "mollification": added}
    return SurfaceOperator(
        faces, hat_gradients, areas, len(mesh.vertices), name="intrinsic_delaunay", metrics=metrics, notes=tuple(notes)
    )


def hat_gradients_from_lengths(lengths: Floats) -> tuple[Floats, Floats]:
    """Return hat gradients (m, 3, 2), in a frame along the side from corner 0 to corner 1, and areas (m,).

    Parameters
    ----------
    lengths : (m, 3) float64
        Of the sides from corner k to corner k + 1.
    """
    side, across, back = lengths.T
    areas = triangle_areas(lengths)
    along = (side**2 + back**2 - across**2) / (2.0 * side)
    hats = np.zeros((len(lengths), 3, 2))
    hats[:, 1, 0], hats[:, 1, 1] = 1.0 / side, -along / (2.0 * areas)
    hats[:, 2, 1] = side / (2.0 * areas)
    hats[:, 0] = -hats[:, 1] - hats[:, 2]
    return hats, areas
