"""OFF files."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.io.polygons import triangulate
from surfexp.mesh.triangle_mesh import TriangleMesh


def read_off(path: Path) -> tuple[Floats, Integers]:
    """Vertices and faces of an ASCII OFF file; normals, colours and texture coordinates are left out.

    Raises
    ------
    ValueError
        If the file breaks the format or ends early.
    """
    lines = [line for raw in path.read_text("ascii", "replace").splitlines() if (line := raw.split("#")[0].split())]
    if not lines or not lines[0][0].endswith("OFF") or len(lines[0][0]) > 6:
        raise ValueError("the first word is not OFF")
    head = lines[0][1:] or (lines.pop(1) if len(lines) > 1 else [])
    if len(head) < 2:
        raise ValueError("the counts of vertices and faces are missing")
    vertex_count, face_count = int(head[0]), int(head[1])
    body = lines[1:]
    if len(body) < vertex_count + face_count:
        raise ValueError(f"it ends after {len(body)} of {vertex_count} vertices and {face_count} faces")
    vertices = np.array([line[:3] for line in body[:vertex_count]], dtype=np.float64)
    rows = body[vertex_count : vertex_count + face_count]
    polygons = [list(map(int, row[1 : 1 + int(row[0])])) for row in rows]
    short = [index for index, row in enumerate(rows) if len(polygons[index]) != int(row[0])]
    if short:
        raise ValueError(f"face {short[0]} is cut short: {' '.join(rows[short[0]])!r}")
    return vertices, triangulate(polygons)


def write_off(path: Path, mesh: TriangleMesh) -> None:
    """Write vertices with all their digits, and faces."""
    vertices = "\n".join(" ".join(map(repr, row)) for row in mesh.vertices.tolist())
    faces = "\n".join(f"3 {a} {b} {c}" for a, b, c in mesh.faces.tolist())
    path.write_text(f"OFF\n{len(mesh.vertices)} {len(mesh.faces)} 0\n{vertices}\n{faces}\n")
