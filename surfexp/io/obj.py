"""Wavefront OBJ files."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.io.polygons import triangulate
from surfexp.mesh.triangle_mesh import TriangleMesh

# fmt: off
IGNORED = {
    "vt", "vn", "vp", "g", "o", "s", "usemtl", "mtllib", "l", "p", "usemap", "maplib", "cstype", "deg", "curv", "surf", "end",
    "lod", "bevel", "c_interp", "d_interp",
}
# fmt: on


def read_obj(path: Path) -> tuple[Floats, Integers]:
    """Vertices and faces of an OBJ file; texture, normals, materials, groups and lines are left out.

    Raises
    ------
    ValueError
        If a statement is unknown or cut short, or no vertex or face is there.
    """
    vertices: list[list[float]] = []
    polygons: list[list[int]] = []
    for number, line in enumerate(path.read_text("utf-8", "replace").replace("\\\n", " ").splitlines(), 1):
        words = line.split("#")[0].split()
        if not words or words[0] in IGNORED:
            continue
        try:
            if words[0] == "v" and len(words) >= 4:
                vertices.append([float(word) for word in words[1:4]])
                continue
            if words[0] == "f" and len(words) >= 4:
                corners = [int(word.split("/")[0]) for word in words[1:]]
                polygons.append([corner - 1 if corner > 0 else len(vertices) + corner for corner in corners])
                continue
        except ValueError:
            pass
        raise ValueError(f"line {number} is not an OBJ statement or is cut short: {line[:40]!r}")
    if not vertices or not polygons:
        raise ValueError(f"it has {len(vertices)} vertices and {len(polygons)} faces, at least one of each is needed")
    return np.array(vertices), triangulate(polygons)


def write_obj(path: Path, mesh: TriangleMesh) -> None:
    """Write vertices with all their digits, and faces."""
    lines = ["v " + " ".join(map(repr, row)) for row in mesh.vertices.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (mesh.faces + 1).tolist()]
    path.write_text("\n".join(lines) + "\n")
