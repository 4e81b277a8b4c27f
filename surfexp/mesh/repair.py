"""Repair of triangle meshes: every defect that `validate` calls repairable, each change reported."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from surfexp.contract.arrays import Integers
from surfexp.mesh.equal_rows import first_equal_row
from surfexp.mesh.face_repair import drop_bad_faces, drop_faces_at_crowded_edges, flip_zero_area_faces
from surfexp.mesh.length_scale import scaled
from surfexp.mesh.orientation import (
    corner_fans,
    flipped_faces,
    inconsistent_edges,
    inside_out_components,
    turn_over,
)
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.validate import validate
from surfexp.mesh.zero_edges import contract_zero_edges

SHIFT = 1e-3


class Repaired(NamedTuple):
    """A mesh without repairable defects.

    Parameters
    ----------
    mesh : TriangleMesh
    changes : tuple of str
        What was done, one sentence each; empty when nothing had to be.
    origin : (n,) int64
        The vertex of the input from which each vertex comes: `scalar_map[origin]` follows the repair.
    """

    mesh: TriangleMesh
    changes: tuple[str, ...]
    origin: Integers


def repair(vertices: ArrayLike, faces: ArrayLike, largest_component: bool = False) -> Repaired:
    """Mend a mesh so that `validate` finds nothing but notes; a mesh without defects comes back unchanged.

    Merges vertices of equal position on boundaries or joined by an edge, and moves others apart; drops faces with a repeated
    index and copies of faces; flips faces without area into their neighbours; at an edge with more than two faces keeps the two
    that hang together best and drops the others; orients faces consistently and closed components outward; cuts where
    no orientation is possible; splits vertices at which several fans meet; drops faces at vertices that are not finite, and
    vertices without faces.

    Parameters
    ----------
    vertices : (n, 3)
    faces : (m, 3)
    largest_component : bool
        Whether to keep only the component of largest area.

    Raises
    ------
    ValueError
        If the mesh has a defect that nothing mends, or nothing is left of it.
    """
    report = validate(vertices, faces)
    fatal = [str(defect) for defect in report.defects if defect.severity == "refuse"]
    if fatal:
        raise ValueError(f"mesh has {'; '.join(fatal)}; no repair is possible: give a mesh without")
    mesh, scale = scaled(TriangleMesh(np.asarray(vertices, dtype=float), np.asarray(faces)))
    origin = np.arange(len(mesh.vertices))
    changes: list[str] = []
    unknown = ~np.isfinite(mesh.vertices[mesh.faces]).all(axis=(1, 2))
    if unknown.any():
        changes.append(f"dropped, because a corner is not finite: {unknown.sum()} faces")
        mesh, origin = _drop_unreferenced(TriangleMesh(mesh.vertices, mesh.faces[~unknown]), origin, changes)
    for _ in range(10):
        found = validate(mesh.vertices, mesh.faces)
        if found.ok and not found.count("unreferenced vertices"):
            break
        mesh, origin = _one_round(mesh, origin, changes)
    else:
        raise ValueError(f"mesh still has {'; '.join(validate(mesh.vertices, mesh.faces).lines())} after ten repairs")
    if largest_component and mesh.component_count > 1:
        dropped = mesh.component_count - 1
        mesh, origin = _keep_largest_component(mesh, origin)
        changes.append(f"dropped, all but the one of largest area: {dropped} components")
    return Repaired(mesh if scale == 1.0 else TriangleMesh(scale * mesh.vertices, mesh.faces), tuple(changes), origin)


def _one_round(mesh: TriangleMesh, origin: Integers, changes: list[str]) -> tuple[TriangleMesh, Integers]:
    mesh, origin = _merge_vertices(mesh, origin, changes)
    faces = drop_bad_faces(mesh, changes)
    faces = contract_zero_edges(TriangleMesh(mesh.vertices, faces), changes)
    faces = flip_zero_area_faces(TriangleMesh(mesh.vertices, faces), changes)
    faces = drop_faces_at_crowded_edges(TriangleMesh(mesh.vertices, faces), changes)
    if not len(faces):
        raise ValueError("mesh has no face of positive area; nothing is left after repair, give a mesh that has one")
    mesh = TriangleMesh(mesh.vertices, _orient(TriangleMesh(mesh.vertices, faces), changes))
    mesh, origin = _split_fans(mesh, origin, changes)
    mesh, origin = _drop_unreferenced(mesh, origin, changes)
    return _move_apart(mesh, changes), origin


def _merge_vertices(mesh: TriangleMesh, origin: Integers, changes: list[str]) -> tuple[TriangleMesh, Integers]:
    # a vertex inside its surface gains nothing from a merger, which would only glue two sheets together
    open_edges = mesh.edges[mesh.edge_face_counts == 1]
    inside = np.ones(len(mesh.vertices), dtype=np.int64)
    inside[open_edges] = 0
    rows = np.column_stack([mesh.vertices + 0.0, inside * np.arange(1, len(inside) + 1)])
    first = first_equal_row(rows)
    kept = first == np.arange(len(first))
    if kept.all():
        return mesh, origin
    changes.append(f"merged into a vertex at the same position: {(~kept).sum()} vertices")
    return TriangleMesh(mesh.vertices[kept], (np.cumsum(kept) - 1)[first[mesh.faces]]), origin[kept]


def _orient(mesh: TriangleMesh, changes: list[str]) -> Integers:
    faces = mesh.faces
    if inconsistent_edges(mesh).any():
        flipped = flipped_faces(mesh)
        faces = turn_over(faces, flipped)
        if flipped.any():
            changes.append(f"turned over, against their neighbours: {flipped.sum()} faces")
    inward = inside_out_components(TriangleMesh(mesh.vertices, faces))
    if inward.any():
        changes.append(f"turned over, because their closed component was inside out: {inward.sum()} faces")
    return turn_over(faces, inward)


def _split_fans(mesh: TriangleMesh, origin: Integers, changes: list[str]) -> tuple[TriangleMesh, Integers]:
    cut = inconsistent_edges(mesh)
    fans = corner_fans(mesh, ~cut)
    owner = np.empty(fans.max() + 1, dtype=np.int64)
    owner[fans.ravel()] = mesh.faces.ravel()
    order = np.argsort(owner, kind="stable")
    place = np.empty(len(owner), dtype=np.int64)
    place[order] = np.arange(len(owner)) - np.searchsorted(owner[order], owner[order])
    if not place.any():
        return mesh, origin
    if cut.any():
        changes.append(f"cut, because no orientation is possible: {cut.sum()} edges")
    changes.append(f"split, because several fans of faces met there: {np.sum(place == 1)} vertices")
    copies = np.flatnonzero(place > 0)
    number = owner.copy()
    number[copies] = len(mesh.vertices) + np.arange(len(copies))
    parents = owner[copies]
    return (
        TriangleMesh(np.concatenate([mesh.vertices, mesh.vertices[parents]]), number[fans]),
        np.concatenate([origin, origin[parents]]),
    )


def _move_apart(mesh: TriangleMesh, changes: list[str]) -> TriangleMesh:
    """Vertices at the same position, each moved toward the middle of its own faces by another small amount."""
    first = first_equal_row(mesh.vertices)
    order = np.argsort(first, kind="stable")
    place = np.empty(len(first), dtype=np.int64)
    place[order] = np.arange(len(first)) - np.searchsorted(first[order], first[order])
    if not place.any():
        return mesh
    changes.append(
        f"moved apart by {SHIFT:g} of the ring's radius, because positions were equal: {np.sum(place > 0)} vertices"
    )
    middles = mesh.vertices[mesh.faces].mean(axis=1).repeat(3, axis=0)
    corner, n = mesh.faces.ravel(), len(mesh.vertices)
    sums = np.stack([np.bincount(corner, middles[:, k], n) for k in range(3)], axis=1)
    centres = sums / np.maximum(np.bincount(corner, minlength=n), 1)[:, None]
    return TriangleMesh(mesh.vertices + SHIFT * place[:, None] * (centres - mesh.vertices), mesh.faces)


def _drop_unreferenced(
    mesh: TriangleMesh, origin: Integers, changes: list[str] | None = None
) -> tuple[TriangleMesh, Integers]:
    used, faces = np.unique(mesh.faces, return_inverse=True)
    if changes is not None and len(used) < len(mesh.vertices):
        changes.append(f"dropped, because no face uses them: {len(mesh.vertices) - len(used)} vertices")
    return TriangleMesh(mesh.vertices[used], faces.reshape(-1, 3)), origin[used]


def _keep_largest_component(mesh: TriangleMesh, origin: Integers) -> tuple[TriangleMesh, Integers]:
    label = mesh.component_labels[mesh.faces[:, 0]]
    kept = label == np.bincount(label, mesh.areas).argmax()
    return _drop_unreferenced(TriangleMesh(mesh.vertices, mesh.faces[kept]), origin)
