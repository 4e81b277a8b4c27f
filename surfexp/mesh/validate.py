"""Every defect that a triangle mesh can have, found and named."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from surfexp.contract.arrays import Integers
from surfexp.mesh.equal_rows import later_copies
from surfexp.mesh.length_scale import scaled
from surfexp.mesh.orientation import (
    corner_fans,
    fans_per_vertex,
    flipped_faces,
    inconsistent_edges,
    inside_out_components,
)
from surfexp.mesh.thin_faces import sharp_faces, zero_area_faces
from surfexp.mesh.triangle_mesh import TriangleMesh

Severity = Literal["refuse", "repairable", "note"]
# volumes are products of three lengths: beyond these they overflow or vanish in double precision
LARGEST_COORDINATE, SMALLEST_EXTENT = 1e102, 1e-102
SLIVER_DEGREES = 5.0
# kinds of defects that a refusal names: it is one line
SHOWN_KINDS = 3


@dataclass(frozen=True)
class Defect:
    """One kind of defect.

    Parameters
    ----------
    kind : str
        What was counted, in the plural: "flipped faces".
    count : int
    severity : "refuse", "repairable" or "note"
        Nothing mends it; `repair` mends it; worth knowing only.
    examples : tuple of str
        The first three: "face 17", "edge 3-8", ...
    """

    kind: str
    count: int
    severity: Severity
    examples: tuple[str, ...] = ()

    def __str__(self) -> str:
        examples = f" ({', '.join(self.examples)}{', ...' if self.count > len(self.examples) else ''})"
        return f"{self.count} {self.kind}{examples if self.examples else ''}"


@dataclass(frozen=True)
class Report:
    """All defects found.

    Parameters
    ----------
    defects : tuple of Defect
        One entry a kind, in the order in which they were looked for.
    """

    defects: tuple[Defect, ...]

    @property
    def ok(self) -> bool:
        """Whether every method may use the mesh: nothing but notes."""
        return all(defect.severity == "note" for defect in self.defects)

    def count(self, kind: str) -> int:
        """Count the defects of a kind.

        Parameters
        ----------
        kind : str
            As in `lines`: "duplicate faces".

        Returns
        -------
        int
            0 when there is none.
        """
        return sum(defect.count for defect in self.defects if defect.kind == kind)

    def lines(self) -> list[str]:
        """Name the defects.

        Returns
        -------
        list of str
            One line for each kind, with its severity.
        """
        return [f"{defect.severity}: {defect}" for defect in self.defects] or ["no defect"]


def validate(vertices: ArrayLike, faces: ArrayLike) -> Report:
    """Look for every defect of a mesh given as arrays.

    Wrong shapes, no faces, values that are not finite and indices out of range end the search, because nothing else
    means anything on such arrays.

    Parameters
    ----------
    vertices : (n, 3)
    faces : (m, 3)
    """
    points, corners = np.asarray(vertices), np.asarray(faces)
    refused = tuple(_array_defects(points, corners))
    return Report(refused) if refused else Report(tuple(_mesh_defects(scaled(TriangleMesh(points, corners))[0])))


def require_valid(
    mesh: TriangleMesh,
    name: str = "FILE",
    allow: tuple[str, ...] = (),
    one_component: bool = False,
    repair: str = "",
    numbers: tuple[Integers, Integers] | None = None,
) -> None:
    """Refuse a mesh with defects, in one line that says what mends it.

    Parameters
    ----------
    mesh : TriangleMesh
    name : str
        The file, as the user named it.
    allow : tuple of str
        Kinds of repairable defects that do no harm to the caller.
    one_component : bool
        Whether several components are refused too.
    repair : str
        What repairs it; the command on a file if not given.
    numbers : tuple of (n,) and (m,) int64, optional
        Of the vertices and faces, where the mesh is a part of another.

    Raises
    ------
    ValueError
        If there is a defect.
    """
    # of this very mesh, so that its edges are found once
    defects = tuple(_array_defects(mesh.vertices, mesh.faces)) or tuple(_mesh_defects(scaled(mesh)[0]))
    fatal = [defect for defect in defects if defect.severity == "refuse"]
    if fatal:
        raise ValueError(f"mesh {name} has {_listed(fatal)}; no repair is possible: give a mesh without")
    found = [defect for defect in defects if defect.severity == "repairable" and defect.kind not in allow]
    if found:
        found = found if numbers is None else [_renumbered(defect, *numbers) for defect in found]
        way_out = repair or f"give --repair (repair=True), or surfexp repair {name} --to repaired.ply"
        raise ValueError(f"mesh {name} has {_listed(found)}; none allowed: {way_out}")
    if one_component and mesh.component_count > 1:
        raise ValueError(
            f"mesh {name} has {mesh.component_count} components, 1 is allowed here: "
            f"surfexp repair {name} --largest-component --to repaired.ply"
        )


def _renumbered(defect: Defect, vertices: Integers, faces: Integers) -> Defect:
    """The same defect, its examples in the numbers of the whole."""
    said = []
    for example in defect.examples:
        label, _, numbers = example.partition(" ")
        rows = faces if label == "face" else vertices
        said.append(f"{label} {'-'.join(str(rows[int(number)]) for number in numbers.split('-'))}")
    return replace(defect, examples=tuple(said))


def _listed(defects: list[Defect]) -> str:
    """The first three kinds of defects, and how many more there are; `surfexp check` has them all."""
    shown = "; ".join(map(str, defects[:SHOWN_KINDS]))
    return shown if len(defects) <= SHOWN_KINDS else f"{shown}; {len(defects) - SHOWN_KINDS} more kinds of defects"


def repeated_index_faces(mesh: TriangleMesh) -> NDArray[np.bool_]:
    """(m,) faces that name a vertex twice."""
    a, b, c = mesh.faces.T
    return np.asarray((a == b) | (b == c) | (c == a))


def _entry(
    kind: str, severity: Severity, where: NDArray[Any], label: str, rows: NDArray[Any] | None = None
) -> Iterator[Defect]:
    found = np.flatnonzero(where)
    if len(found):
        shown = found[:3].tolist() if rows is None else ["-".join(map(str, row)) for row in rows[found[:3]].tolist()]
        yield Defect(kind, len(found), severity, tuple(f"{label} {item}" for item in shown))


def _array_defects(vertices: NDArray[Any], faces: NDArray[Any]) -> Iterator[Defect]:
    for name, array, kinds in (("vertices", vertices, "iuf"), ("faces", faces, "iu")):
        empty = array.size == 0
        if (array.ndim != 2 or array.shape[1] != 3 or array.dtype.kind not in kinds) and not empty:
            yield Defect(f"{name} array of the wrong shape or type", 1, "refuse", (f"{array.shape} {array.dtype}",))
            return
    if faces.size == 0 or vertices.size == 0:
        yield Defect("missing faces or vertices", 1, "refuse", (f"{len(vertices)} vertices, {len(faces)} faces",))
        return
    unknown = ~np.isfinite(vertices).all(axis=1)
    inside = faces[((faces >= 0) & (faces < len(vertices))).all(axis=1)]
    cut = unknown[inside].any(axis=1)
    if cut.any():
        severity: Severity = "refuse" if cut.all() else "repairable"
        yield from _entry("vertices that are not finite", severity, unknown, "vertex")
    known = vertices[~unknown]
    far = float(np.abs(known).max(initial=0.0))
    extent = float(np.ptp(known, axis=0).max()) if len(known) else 1.0
    if far > LARGEST_COORDINATE or 0.0 < extent < SMALLEST_EXTENT:
        said = f"largest {far:g}, extent {extent:g}, {SMALLEST_EXTENT:g} to {LARGEST_COORDINATE:g} can be computed with"
        yield Defect("unit of length out of range", 1, "refuse", (f"{said}: change the unit",))
        return
    outside = np.any((faces < 0) | (faces >= len(vertices)), axis=1)
    yield from _entry("faces with an index out of range", "refuse", outside, "face")


def _mesh_defects(mesh: TriangleMesh) -> Iterator[Defect]:
    yield from _face_defects(mesh)
    yield from _vertex_defects(mesh)
    yield from _manifold_defects(mesh)
    yield from _notes(mesh)


def _face_defects(mesh: TriangleMesh) -> Iterator[Defect]:
    repeated = repeated_index_faces(mesh)
    yield from _entry("faces with a repeated index", "repairable", repeated, "face")
    yield from _entry("zero-area faces", "repairable", zero_area_faces(mesh) & ~repeated, "face")
    yield from _entry("duplicate faces", "repairable", later_copies(np.sort(mesh.faces, axis=1)), "face")


def _vertex_defects(mesh: TriangleMesh) -> Iterator[Defect]:
    used = np.zeros(len(mesh.vertices), dtype=bool)
    used[mesh.faces] = True
    copies = np.zeros(len(used), dtype=bool)
    copies[used] = later_copies(mesh.vertices[used])
    yield from _entry("duplicate vertices", "repairable", copies, "vertex")
    yield from _entry("unreferenced vertices", "note", ~used, "vertex")


def _manifold_defects(mesh: TriangleMesh) -> Iterator[Defect]:
    repeated = repeated_index_faces(mesh)
    if repeated.any():
        mesh = TriangleMesh(mesh.vertices, mesh.faces[~repeated])
    if not len(mesh.faces):
        return
    yield from _entry("non-manifold edges", "repairable", mesh.edge_face_counts > 2, "edge", mesh.edges)
    fans = fans_per_vertex(mesh, corner_fans(mesh, np.ones(len(mesh.edges), dtype=bool)))
    yield from _entry("non-manifold vertices", "repairable", fans > 1, "vertex")
    if inconsistent_edges(mesh).any():
        flipped = flipped_faces(mesh)
        yield from _entry("flipped faces", "repairable", flipped, "face")
        turned = TriangleMesh(mesh.vertices, np.where(flipped[:, None], mesh.faces[:, ::-1], mesh.faces))
        rest = inconsistent_edges(turned)
        yield from _entry("edges where no orientation is possible", "repairable", rest, "edge", mesh.edges)
    yield from _entry("faces of inside-out closed components", "repairable", inside_out_components(mesh), "face")


def _notes(mesh: TriangleMesh) -> Iterator[Defect]:
    if mesh.component_count > 1:
        yield Defect("components", mesh.component_count, "note")
    if mesh.boundary_loops:
        yield Defect("boundary loops", len(mesh.boundary_loops), "note")
    yield from _entry(
        f"faces with an angle under {SLIVER_DEGREES:g} degrees", "note", sharp_faces(mesh, SLIVER_DEGREES), "face"
    )
